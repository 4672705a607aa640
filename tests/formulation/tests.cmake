talus_test(formulation/test_tangent)
