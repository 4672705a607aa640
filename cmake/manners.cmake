include(GNUInstallDirs)

# What the program carries and says about itself: its first case as a C string; the manual page and the completions of
# shells, written by the program that was just built.
set(first_case ${PROJECT_SOURCE_DIR}/src/cli/begin/first_case.yaml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${first_case})
file(READ ${first_case} TALUS_FIRST_CASE)
string(REPLACE "\\" "\\\\" TALUS_FIRST_CASE "${TALUS_FIRST_CASE}")
string(REPLACE "\"" "\\\"" TALUS_FIRST_CASE "${TALUS_FIRST_CASE}")
string(REPLACE "\n" "\\n\"\n  \"" TALUS_FIRST_CASE "${TALUS_FIRST_CASE}")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/first_case.h @ONLY
  CONTENT "static const char first_case[] =\n  \"@TALUS_FIRST_CASE@\";\n")

# talus_says(FILE ARGUMENT...): FILE in build/manners is what `talus ARGUMENT...` prints.
set(manners ${PROJECT_BINARY_DIR}/manners)
file(MAKE_DIRECTORY ${manners})
function(talus_says file)
  add_custom_command(OUTPUT ${manners}/${file} DEPENDS talus VERBATIM COMMENT "talus ${ARGN}"
    COMMAND $<TARGET_FILE:talus> ${ARGN} > ${manners}/${file})
  set_property(DIRECTORY APPEND PROPERTY TALUS_MANNERS ${manners}/${file})
endfunction()
talus_says(talus.1 help --man)
talus_says(talus.bash completion bash)
talus_says(_talus completion zsh)
talus_says(talus.fish completion fish)
get_property(said DIRECTORY PROPERTY TALUS_MANNERS)
add_custom_target(talus_manners DEPENDS ${said})
if(NOT TALUS_SANITIZE) # which would look for leaks of MPI, too
  set_target_properties(talus_manners PROPERTIES EXCLUDE_FROM_ALL OFF)
endif()

set(TALUS_ZSH_COMPLETIONS ${CMAKE_INSTALL_DATADIR}/zsh/site-functions CACHE STRING "Where zsh looks for completions of packages")
install(FILES ${manners}/talus.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${manners}/talus.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME talus)
install(FILES ${manners}/_talus DESTINATION ${TALUS_ZSH_COMPLETIONS})
install(FILES ${manners}/talus.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

# Cases without their pictures, which the site shows; the site if `make docs` has built it.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/cases/ DESTINATION ${CMAKE_INSTALL_DATADIR}/talus/cases PATTERN "*.png" EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/example DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_BINARY_DIR}/docs/html DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)
