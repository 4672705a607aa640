talus_test(solve/test_blocks RANKS 1 2 3)
