talus_test(base/test_diag RANKS 1 2 3)
talus_test(base/test_eigen)
talus_test(base/test_lanes)
talus_test(base/test_table)
