talus_test(api/test_api RANKS 1 2 3)
talus_test(api/test_halves RANKS 1 2 3)
talus_test(api/test_hooks RANKS 1 2 3)

# The header alone, as C++ reads it (without MPI's own C++, which is no more).
include(CheckLanguage)
check_language(CXX)
if(CMAKE_CXX_COMPILER)
  list(TRANSFORM MPI_C_INCLUDE_DIRS PREPEND -isystem OUTPUT_VARIABLE mpi_headers)
  add_test(NAME api/header_is_cxx COMMAND ${CMAKE_CXX_COMPILER} -std=c++11 -Wall -Wextra -Wpedantic -Werror -fsyntax-only
    -DOMPI_SKIP_MPICXX -DMPICH_SKIP_MPICXX ${mpi_headers} -x c++ ${PROJECT_SOURCE_DIR}/include/talus.h)
endif()
