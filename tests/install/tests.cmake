# Installs talus, then builds and runs docs/example/ten_lines.c against the installation. Waits for the header and the
# example; a program of the outside cannot link a library full of sanitizer calls.
file(GLOB example CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/talus.h ${PROJECT_SOURCE_DIR}/docs/example/ten_lines.c)
list(LENGTH example pieces)
if(pieces EQUAL 2 AND TARGET talus AND NOT TALUS_SANITIZE AND NOT TALUS_TEST_SHARED)
  add_test(NAME install/ten_lines COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/test_install.sh
    ${CMAKE_COMMAND} ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${CMAKE_C_COMPILER})
  set_tests_properties(install/ten_lines PROPERTIES TIMEOUT 180 PROCESSORS 2 ENVIRONMENT "${TALUS_TEST_ENVIRONMENT}")
endif()
