# Supports `cmake --install` and find_package(simwright); docs/architecture.md shows an external
# project.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
install(EXPORT simwright_targets NAMESPACE simwright:: DESTINATION lib/cmake/simwright)
configure_package_config_file(cmake/simwrightConfig.cmake.in
  ${CMAKE_BINARY_DIR}/simwrightConfig.cmake INSTALL_DESTINATION lib/cmake/simwright)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/simwrightConfigVersion.cmake
  COMPATIBILITY SameMajorVersion)
get_property(simwright_modules GLOBAL PROPERTY simwright_modules)
set(components "set(simwright_modules ${simwright_modules})\n")
foreach(module ${simwright_modules})
  get_property(links GLOBAL PROPERTY simwright_links_${module})
  string(APPEND components "set(simwright_links_${module} ${links})\n")
endforeach()
file(WRITE ${CMAKE_BINARY_DIR}/simwright_components.cmake "${components}")
install(FILES ${CMAKE_BINARY_DIR}/simwrightConfig.cmake
              ${CMAKE_BINARY_DIR}/simwright_components.cmake
              ${CMAKE_BINARY_DIR}/simwrightConfigVersion.cmake
              cmake/simwright_dependencies.cmake
        DESTINATION lib/cmake/simwright)
