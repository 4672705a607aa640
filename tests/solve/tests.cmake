talus_test(solve/test_step_control)
