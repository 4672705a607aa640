talus_test(basis/test_cell)
talus_test(basis/test_quadrature)
talus_test(basis/test_mls)
talus_test(basis/test_lme)
