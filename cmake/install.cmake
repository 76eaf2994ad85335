# SPDX-License-Identifier: BSD-3-Clause
# `cmake --install` puts the program, libraries and headers in place; others then write
# find_package(pixelsynth) and link pixelsynth::geometry, pixelsynth::io, ...
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY PIXELSYNTH_ROOMS)
install(TARGETS ${rooms} pixelsynth_pcl EXPORT pixelsynth-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS pixelsynth RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY libps io DESTINATION include/pixelsynth FILES_MATCHING PATTERN "*.h")
install(EXPORT pixelsynth-targets NAMESPACE pixelsynth::
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pixelsynth)
configure_package_config_file(cmake/pixelsynth-config.cmake.in pixelsynth-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pixelsynth)
write_basic_package_version_file(pixelsynth-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/pixelsynth-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/pixelsynth-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pixelsynth)
