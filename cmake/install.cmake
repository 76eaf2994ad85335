# SPDX-License-Identifier: BSD-3-Clause
# `cmake --install` puts the program, libraries and headers in place; others then write
# find_package(pixelsynth) and link pixelsynth::geometry, pixelsynth::io, ...
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY PIXELSYNTH_ROOMS)
install(TARGETS ${rooms} pixelsynth_pcl EXPORT pixelsynth-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS pixelsynth RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/weights DESTINATION ${CMAKE_INSTALL_DATADIR}/pixelsynth OPTIONAL)
install(TARGETS pixelsynth_viewer pixelsynth_video LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/pixelsynth)
if(PIXELSYNTH_TORCH)
  install(TARGETS pixelsynth_trainer LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/pixelsynth)
endif()

# The trainer is a program's part, not a library for others: it stands on whichever libtorch is there.
# A header that says "// Internal to ..." first is its room's own affair.
file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} libps/*.h io/*.h)
list(FILTER headers EXCLUDE REGEX "^libps/train/")
foreach(header IN LISTS headers)
  file(STRINGS ${header} internal LIMIT_COUNT 1 REGEX "^// Internal to ")
  if(NOT internal)
    get_filename_component(folder ${header} DIRECTORY)
    install(FILES ${header} DESTINATION include/pixelsynth/${folder})
  endif()
endforeach()
install(EXPORT pixelsynth-targets NAMESPACE pixelsynth::
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pixelsynth)
configure_package_config_file(cmake/pixelsynth-config.cmake.in pixelsynth-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pixelsynth)
write_basic_package_version_file(pixelsynth-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/pixelsynth-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/pixelsynth-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pixelsynth)
