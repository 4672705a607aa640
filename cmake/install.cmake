# The library (static and shared) and what an installation needs: pkg-config and CMake package files.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

add_library(talus_library STATIC)
add_library(talus_shared SHARED)
foreach(library talus_library talus_shared)
  foreach(room ${TALUS_ROOMS})
    target_sources(${library} PRIVATE $<TARGET_OBJECTS:talus_${room}>)
  endforeach()
  # The build tree has its own flags; a user of the installation finds PETSc on the machine it stands on.
  target_link_libraries(${library} PUBLIC $<BUILD_INTERFACE:talus_flags>
    $<INSTALL_INTERFACE:PkgConfig::TALUS_PETSC> $<INSTALL_INTERFACE:MPI::MPI_C>)
  target_include_directories(${library} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  set_target_properties(${library} PROPERTIES OUTPUT_NAME talus LINKER_LANGUAGE C)
endforeach()
target_link_libraries(talus_library PUBLIC $<INSTALL_INTERFACE:PkgConfig::TALUS_HDF5>
  $<INSTALL_INTERFACE:PkgConfig::TALUS_FYAML> $<INSTALL_INTERFACE:PkgConfig::TALUS_ZLIB> $<INSTALL_INTERFACE:m>)
target_link_options(talus_shared PRIVATE -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/talus.map)
set_target_properties(talus_library PROPERTIES EXPORT_NAME static)
set_target_properties(talus_shared PROPERTIES EXPORT_NAME talus
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
  LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/talus.map)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/talus)
install(TARGETS talus_library talus_shared EXPORT talusTargets)
install(EXPORT talusTargets NAMESPACE talus:: DESTINATION ${package_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/ TYPE INCLUDE FILES_MATCHING PATTERN "*.h")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CITATION.cff TYPE DOC)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/talusConfig.cmake.in ${PROJECT_BINARY_DIR}/talusConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/talusConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/talusConfig.cmake ${PROJECT_BINARY_DIR}/talusConfigVersion.cmake
  DESTINATION ${package_dir})

# Debian's PETSc.pc does not name MPI, whose headers its own include.
pkg_search_module(TALUS_MPI QUIET ompi-c mpi-c mpich)
set(TALUS_MPI_MODULE ${TALUS_MPI_MODULE_NAME})
file(RELATIVE_PATH TALUS_PREFIX_FROM_PC /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(${PROJECT_SOURCE_DIR}/cmake/talus.pc.in ${PROJECT_BINARY_DIR}/talus.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/talus.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
