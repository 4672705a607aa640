talus_test(points/test_table)
talus_test(points/test_seed RANKS 1 2 3)
talus_test(points/test_relocate RANKS 1 2 3)
talus_test(points/test_mesh RANKS 1 2 3)
