include(${CMAKE_CURRENT_LIST_DIR}/verify.cmake OPTIONAL)
