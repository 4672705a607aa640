talus_test(base/test_diag RANKS 1 2 3)
talus_test(base/test_eigen)
talus_test(base/test_lanes)
talus_test(base/test_lu)
talus_test(base/test_names)
# Fails on one rank, as it must, and is over at once: its message is what counts.
talus_test(base/test_fails_alone RANKS 3 TIMEOUT 60)
set_tests_properties(base/test_fails_alone_3 PROPERTIES PASS_REGULAR_EXPRESSION "the last rank fails alone")
talus_test(base/test_table)
