# How the house is built: includes run down, names keep to the rule of CONTRIBUTING.md, folders can be held in mind.
add_test(NAME house/versions COMMAND sh ${PROJECT_SOURCE_DIR}/packaging/release-check.sh --agree)
foreach(rule rooms names folders fails)
  add_test(NAME house/${rule} COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/${rule}.sh ${PROJECT_SOURCE_DIR})
endforeach()
