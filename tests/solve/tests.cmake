talus_test(solve/test_step_control)
talus_test(solve/test_blocks RANKS 1 2 3)
