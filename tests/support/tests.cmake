talus_test(support/test_support RANKS 1 2)
talus_test(support/test_gimp)
