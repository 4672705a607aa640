talus_test(run/test_state RANKS 1 2 3)
talus_test(run/test_memory)
include(${CMAKE_CURRENT_LIST_DIR}/verify.cmake OPTIONAL)
