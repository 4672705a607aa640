# Compilers that are known to compile some code wrongly are asked, not told by their number.

# talus_check_elements(NAME FLAGS...): NAME is true if code made with FLAGS keeps the elements of vectors apart.
function(talus_check_elements name)
  if(DEFINED ${name})
    return()
  endif()
  list(JOIN ARGN " " CMAKE_C_FLAGS)
  set(CMAKE_TRY_COMPILE_CONFIGURATION Debug)
  set(CMAKE_C_FLAGS_DEBUG "")
  try_run(ran compiled ${PROJECT_BINARY_DIR}/compiler ${PROJECT_SOURCE_DIR}/cmake/compiler/elements.c)
  if(compiled AND ran EQUAL 0)
    set(apart ON)
  else()
    set(apart OFF)
  endif()
  set(${name} ${apart} CACHE INTERNAL "are elements of vectors kept apart with ${ARGN}?")
endfunction()

if(NOT TALUS_PORTABLE)
  talus_check_elements(TALUS_ELEMENTS_APART -O3 -march=native)
  if(NOT TALUS_ELEMENTS_APART)
    talus_check_elements(TALUS_ELEMENTS_MENDED -O3 -march=native -fno-tree-slp-vectorize)
    if(NOT TALUS_ELEMENTS_MENDED)
      message(FATAL_ERROR "this compiler mixes up elements of vectors (cmake/compiler/elements.c): take another one, or -DTALUS_PORTABLE=ON")
    endif()
    target_compile_options(talus_flags INTERFACE -fno-tree-slp-vectorize)
  endif()
endif()

# Tests are many and linked whole; gold takes a fifth of the usual linker's time.
include(CheckLinkerFlag)
check_linker_flag(C -fuse-ld=gold TALUS_HAS_GOLD)
set(TALUS_TEST_LINKER $<$<BOOL:${TALUS_HAS_GOLD}>:-fuse-ld=gold>)

# Programs wait for other ranks in their own way, which MPI's libraries must see.
check_linker_flag(C -Wl,--export-dynamic-symbol=sched_yield TALUS_HAS_EXPORTS)
add_library(talus_yield OBJECT src/cli/yield.c)
target_link_libraries(talus_yield PRIVATE talus_flags)
function(talus_yields target)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:talus_yield>)
  target_link_options(${target} PRIVATE $<$<BOOL:${TALUS_HAS_EXPORTS}>:-Wl,--export-dynamic-symbol=sched_yield>)
endfunction()
