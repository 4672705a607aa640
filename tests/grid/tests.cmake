talus_test(grid/test_box RANKS 1 2 3)
talus_test(grid/test_mesh RANKS 1 2 3)
talus_test(grid/test_mesh_share RANKS 1 2 3)
talus_test(grid/test_geo_check)
