talus_test(basis/test_cell)
talus_test(basis/test_quadrature)
