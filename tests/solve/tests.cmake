talus_test(solve/test_step_control)
talus_test(solve/test_constraints)
talus_test(solve/test_blocks RANKS 1 2 3)
talus_test(solve/test_projection RANKS 1 2 3)
