# Flags that every target shares.
add_library(talus_flags INTERFACE)
target_include_directories(talus_flags INTERFACE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include ${PROJECT_BINARY_DIR}/generated)
target_link_libraries(talus_flags INTERFACE PkgConfig::PETSC MPI::MPI_C PkgConfig::HDF5 PkgConfig::FYAML PkgConfig::ZLIB m)
target_compile_definitions(talus_flags INTERFACE _GNU_SOURCE)
target_compile_options(talus_flags INTERFACE -Wall -Wextra -Wshadow -fno-math-errno -fno-trapping-math
  -fno-semantic-interposition)
if(NOT TALUS_PORTABLE)
  target_compile_options(talus_flags INTERFACE -march=native)
endif()
if(TALUS_FUZZ)
  target_compile_options(talus_flags INTERFACE -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined
    -fno-sanitize=pointer-overflow) # it takes NULL + 0 of an empty array for a mistake
  target_link_options(talus_flags INTERFACE -fsanitize=address,undefined)
endif()
if(TALUS_SANITIZE)
  target_compile_options(talus_flags INTERFACE -g1 -fsanitize=address,undefined -fno-omit-frame-pointer
    -fno-sanitize-recover=undefined) # lines are enough, and -g takes two thirds longer
  target_link_options(talus_flags INTERFACE -fsanitize=address,undefined)
endif()

# Half of the time that a small source takes to compile is for PETSc's headers: gcc compiles them once for the rooms and once
# for their tests. Under sanitizers and by other compilers every source includes what it needs by itself.
if(CMAKE_C_COMPILER_ID STREQUAL "GNU" AND NOT TALUS_SANITIZE)
  set(TALUS_HEADERS <math.h> <stdlib.h> <string.h> <petscdmplex.h>)
endif()

# talus_precompile(KEY TARGET): the first target of a KEY compiles the headers, all others with the same flags reuse them.
function(talus_precompile key target)
  get_property(first GLOBAL PROPERTY TALUS_HEADERS_${key})
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  elseif(TALUS_HEADERS)
    target_precompile_headers(${target} PRIVATE ${TALUS_HEADERS})
    set_property(GLOBAL PROPERTY TALUS_HEADERS_${key} ${target})
  endif()
endfunction()

# One object library a room; a test links the rooms up to its own and no further, so that a room
# that reaches upward does not link.
macro(talus_rooms)
  set(TALUS_ROOMS "")
  foreach(room ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${room}/*.c)
    if(sources)
      add_library(talus_${room} OBJECT ${sources})
      target_link_libraries(talus_${room} PRIVATE talus_flags)
      talus_precompile(rooms talus_${room})
      add_dependencies(talus_${room} talus_version)
      list(APPEND TALUS_ROOMS ${room})
    endif()
  endforeach()
  if(TALUS_EXTEND) # what somebody adds from a folder outside
    file(GLOB sources CONFIGURE_DEPENDS ${TALUS_EXTEND}/*.c)
    add_library(talus_extension OBJECT ${sources})
    target_link_libraries(talus_extension PRIVATE talus_flags)
    target_include_directories(talus_flags INTERFACE ${TALUS_EXTEND})
    list(APPEND TALUS_ROOMS extension)
  endif()
endmacro()

# Laws, bases, ... of a folder outside the house (tests/extend is one): its more_<list>.inc go into the registries, which
# are compiled anew for that, and its sources are added. Registries are the files called registry.c.
function(talus_extend target folder)
  file(GLOB_RECURSE registries CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*/registry.c)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.c)
  list(FILTER sources EXCLUDE REGEX "/test_[a-z_]*\\.c$")
  file(GLOB lists CONFIGURE_DEPENDS ${folder}/*.inc)
  set_source_files_properties(${registries} PROPERTIES OBJECT_DEPENDS "${lists}")
  add_library(${target} OBJECT ${registries} ${sources})
  target_include_directories(${target} PRIVATE ${folder})
  target_link_libraries(${target} PRIVATE talus_flags)
  add_dependencies(${target} talus_version)
endfunction()

# All rooms in one shared library, whatever its names: what is built again after a change is one source and one link.
function(talus_shared_rooms)
  add_library(talus_library SHARED)
  foreach(room ${TALUS_ROOMS})
    target_sources(talus_library PRIVATE $<TARGET_OBJECTS:talus_${room}>)
  endforeach()
  target_link_libraries(talus_library PUBLIC talus_flags)
  set_target_properties(talus_library PROPERTIES OUTPUT_NAME talus_rooms LINKER_LANGUAGE C)
endfunction()

# One thread a rank, Open MPI willing to start as root and with more ranks than cores, and quick to start: no network, no
# daemon for a process by itself, and no look for graphics cards (an eighth of a start, of which the tests make thousands).
set(TALUS_TEST_ENVIRONMENT OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
  OPENBLAS_NUM_THREADS=1 OMPI_MCA_pml=ob1 OMPI_MCA_btl=self,vader OMPI_MCA_ess_singleton_isolated=1
  HWLOC_COMPONENTS=linux,stop HWLOC_PLUGINS_PATH=/nonexistent)
set(TALUS_TEST_PATIENCE 1) # times the usual time limits
if(TALUS_SANITIZE)
  set(TALUS_TEST_PATIENCE 4)
  # On the stack that AddressSanitizer makes for this gcc before 13.3 lays objects of 64 bytes askew (its bug 110027), and
  # what moves them at once on processors with AVX-512 ends.
  set(after_return 1)
  if(CMAKE_C_COMPILER_ID STREQUAL "GNU" AND CMAKE_C_COMPILER_VERSION VERSION_LESS 13.3)
    set(after_return 0)
  endif()
  # Full unwinding, since MPI's libraries keep no frame pointers and their leaks are told by name.
  list(APPEND TALUS_TEST_ENVIRONMENT
    ASAN_OPTIONS=fast_unwind_on_malloc=0:handle_segv=2:detect_stack_use_after_return=${after_return}
    LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/cmake/lsan.supp:print_suppressions=0
    UBSAN_OPTIONS=print_stacktrace=1)
endif()

# talus_test(room/test_name [RANKS 1 2 3] [TIMEOUT s]): builds tests/room/test_name.c and runs it on the ranks given. On
# one rank it carries the label `fast` unless TALUS_SLOW_TESTS (tests/CMakeLists.txt) names it.
add_custom_target(fast_tests)
add_library(talus_test_kernels OBJECT EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/tests/support/kernels.c)
target_link_libraries(talus_test_kernels PRIVATE talus_flags)
function(talus_test path)
  cmake_parse_arguments(arg "" "TIMEOUT" "RANKS" ${ARGN})
  get_filename_component(room ${path} DIRECTORY)
  get_filename_component(name ${path} NAME)
  string(REPLACE "/" "_" target "${room}_${name}")
  # A test that is listed and not there fails, and keeps nobody from configuring.
  file(GLOB source CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${path}.c)
  if(NOT source)
    message(WARNING "tests/${path}.c is listed and not there")
    add_test(NAME ${path} COMMAND ${CMAKE_COMMAND} -E false)
    return()
  endif()
  add_executable(${target} ${path}.c)
  if(room STREQUAL "extend") # all rooms, with the registries that know the folder
    foreach(lower ${TALUS_ROOMS})
      target_sources(${target} PRIVATE $<FILTER:$<TARGET_OBJECTS:talus_${lower}>,EXCLUDE,/registry\\.c>)
    endforeach()
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:talus_extended>)
    set(lower_rooms "")
  else()
    set(lower_rooms ${TALUS_ROOMS})
  endif()
  foreach(lower ${lower_rooms})
    if(TALUS_TEST_SHARED)
      target_link_libraries(${target} PRIVATE talus_library)
      break()
    endif()
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:talus_${lower}>)
    if(lower STREQUAL room)
      break()
    endif()
  endforeach()
  target_link_libraries(${target} PRIVATE talus_flags PkgConfig::CMOCKA)
  target_link_options(${target} PRIVATE ${TALUS_TEST_LINKER})
  talus_yields(${target})
  # What a test itself does takes longer to compile than to run; but those of the ground floor try what its headers inline.
  if(NOT room STREQUAL "base")
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:talus_test_kernels>)
    if(room MATCHES "material|basis|element")
      target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
      talus_precompile(tests_of_numbers ${target})
    else()
      target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O0> -U_FORTIFY_SOURCE)
      talus_precompile(tests ${target})
    endif()
  endif()
  target_compile_definitions(${target} PRIVATE TALUS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/bin)
  if(NOT arg_RANKS)
    set(arg_RANKS 1)
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 400)
  endif()
  math(EXPR arg_TIMEOUT "${TALUS_TEST_PATIENCE} * ${arg_TIMEOUT}")
  foreach(ranks ${arg_RANKS})
    if(ranks EQUAL 1)
      add_test(NAME ${path} COMMAND ${target})
      set(test_name ${path})
    else()
      set(test_name ${path}_${ranks})
      add_test(NAME ${test_name} COMMAND ${MPIEXEC_EXECUTABLE} --oversubscribe -n ${ranks} $<TARGET_FILE:${target}>)
      set_tests_properties(${test_name} PROPERTIES PROCESSORS 2)
    endif()
    set(environment "${TALUS_TEST_ENVIRONMENT}")
    # A failed assertion ends the rank that it fails on, and so all others: they would wait for it until the time is up.
    # Processes by themselves would share a session directory, which the first that ends takes from one that starts.
    if(ranks GREATER 1)
      list(APPEND environment CMOCKA_TEST_ABORT=1)
    else()
      list(APPEND environment OMPI_MCA_orte_create_session_dirs=0)
    endif()
    set_tests_properties(${test_name} PROPERTIES TIMEOUT ${arg_TIMEOUT} ENVIRONMENT "${environment}")
    if(ranks EQUAL 1 AND NOT path IN_LIST TALUS_SLOW_TESTS)
      set_tests_properties(${test_name} PROPERTIES LABELS fast)
      add_dependencies(fast_tests ${target})
    endif()
  endforeach()
endfunction()
