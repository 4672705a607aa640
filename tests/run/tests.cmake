talus_test(run/test_state RANKS 1 2 3)
talus_test(run/test_losses RANKS 1 2 3)
talus_test(run/test_output)
talus_test(run/test_average RANKS 1 2 3)
talus_test(run/test_search)
if(NOT TALUS_TEST_SHARED) # it lets allocations fail that the program itself makes, not its libraries
  talus_test(run/test_memory)
endif()
