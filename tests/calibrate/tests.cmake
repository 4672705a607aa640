talus_test(calibrate/test_surrogate)
if(COMMAND talus_cli)
  talus_cli(calibrate_help 0 "usage: talus calibrate FILE" calibrate --help)
endif()
