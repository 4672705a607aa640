# What somebody adds to talus from outside: a file each, and a line in more_<list>.inc. CONTRIBUTING.md has the recipes.
talus_extend(talus_extended ${CMAKE_CURRENT_LIST_DIR})
talus_test(extend/test_nodal_springs RANKS 1 2)
talus_test(extend/test_kinematics)
talus_test(extend/test_law)
talus_test(extend/test_measure RANKS 1 2)
talus_test(extend/test_time_scheme)
talus_test(extend/test_basis)
