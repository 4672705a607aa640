talus_test(picture/test_plot TIMEOUT 300)
talus_test(picture/test_damage)
talus_test(picture/test_turned)
talus_test(picture/test_walls)
