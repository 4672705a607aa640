talus_test(api/test_api RANKS 1 2 3)

# The header alone, as C++ reads it.
include(CheckLanguage)
check_language(CXX)
if(CMAKE_CXX_COMPILER)
  add_test(NAME api/header_is_cxx COMMAND ${CMAKE_CXX_COMPILER} -std=c++11 -Wall -Wextra -Wpedantic -Werror -fsyntax-only
    -x c++ ${PROJECT_SOURCE_DIR}/include/talus.h)
endif()
