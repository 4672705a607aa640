talus_test(element/test_drive)
if(COMMAND talus_cli)
  talus_cli(element_help 0 "usage: talus element FILE" element --help)
endif()
