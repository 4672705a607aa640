# All patches still fit the sources, and each says what it breaks. Whether tests notice: make test-mutants.
add_test(NAME mutants/apply COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/run.sh --check ${PROJECT_SOURCE_DIR})
set_tests_properties(mutants/apply PROPERTIES TIMEOUT 60)
