# generated/talus_version.h: version, compiler and flags are known when CMake configures; the state of the sources
# is asked of git at every build, and the header is touched only if it changed.
get_target_property(options talus_flags INTERFACE_COMPILE_OPTIONS)
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
string(JOIN " " TALUS_BUILD_FLAGS ${CMAKE_C_FLAGS} ${CMAKE_C_FLAGS_${build_type}} ${options})
string(REGEX REPLACE " ?-f[a-z]+-prefix-map=[^ ]+" "" TALUS_BUILD_FLAGS "${TALUS_BUILD_FLAGS}") # where a package was built is nobody's
set(TALUS_GIT_DESCRIBE "@TALUS_GIT_DESCRIBE@") # stays open for the second pass
configure_file(${PROJECT_SOURCE_DIR}/cmake/talus_version.h.in ${PROJECT_BINARY_DIR}/talus_version.h.in @ONLY)

find_package(Git QUIET)
set(describe ${CMAKE_COMMAND} -D SOURCE=${PROJECT_SOURCE_DIR} -D GIT=${GIT_EXECUTABLE}
  -D TEMPLATE=${PROJECT_BINARY_DIR}/talus_version.h.in -D HEADER=${PROJECT_BINARY_DIR}/generated/talus_version.h
  -P ${PROJECT_SOURCE_DIR}/cmake/describe.cmake)
execute_process(COMMAND ${describe} COMMAND_ERROR_IS_FATAL ANY)
add_custom_target(talus_version COMMAND ${describe} BYPRODUCTS ${PROJECT_BINARY_DIR}/generated/talus_version.h
  COMMENT "Version of the sources" VERBATIM)
