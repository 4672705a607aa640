# cmake -D SOURCE=.. -D GIT=.. -D TEMPLATE=.. -D HEADER=.. -P describe.cmake: fills in what git says, if it says anything.
set(TALUS_GIT_DESCRIBE "")
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --tags --dirty
    OUTPUT_VARIABLE TALUS_GIT_DESCRIBE OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
configure_file(${TEMPLATE} ${HEADER} @ONLY)
