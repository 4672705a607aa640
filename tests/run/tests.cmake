talus_test(run/test_state RANKS 1 2 3)
include(${CMAKE_CURRENT_LIST_DIR}/verify.cmake OPTIONAL)
