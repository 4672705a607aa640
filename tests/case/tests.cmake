talus_test(case/test_shape)
talus_test(case/test_amplitude)
talus_test(case/test_relief)
talus_test(case/test_geotiff)
