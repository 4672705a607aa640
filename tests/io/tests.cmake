include(${CMAKE_CURRENT_LIST_DIR}/case.cmake OPTIONAL)
include(${CMAKE_CURRENT_LIST_DIR}/output.cmake OPTIONAL)
