talus_test(formulation/test_tangent)
talus_test(formulation/test_reference)
