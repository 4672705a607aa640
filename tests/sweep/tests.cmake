talus_test(sweep/test_sweep)
if(COMMAND talus_cli)
  talus_cli(sweep_help 0 "usage: talus sweep CASE" sweep --help)
endif()
