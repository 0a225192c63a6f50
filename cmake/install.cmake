# find_package(gonio) for other projects: targets gonio::brdf, gonio::table, gonio::fit, ...
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/gonio)
install(EXPORT gonio-targets NAMESPACE gonio:: DESTINATION ${package_folder})
configure_package_config_file(cmake/gonio-config.cmake.in gonio-config.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(gonio-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/gonio-config.cmake
  ${PROJECT_BINARY_DIR}/gonio-config-version.cmake DESTINATION ${package_folder})
install(DIRECTORY schema/ DESTINATION ${CMAKE_INSTALL_DATADIR}/gonio/schema
  FILES_MATCHING PATTERN "*.json")
