# Where things go when mpmbench is installed, and what a project needs that builds on its rooms:
#
#   find_package(mpmbench)
#   target_link_libraries(mine PRIVATE mpm::analysis)
#
# Every path is relative to the prefix, and the program looks for its studies beside itself: the tree can be moved.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(MPMBENCH_INSTALLED_HEADERS "${CMAKE_INSTALL_INCLUDEDIR}/mpmbench")
set(MPMBENCH_INSTALLED_DATA "${CMAKE_INSTALL_DATADIR}/mpmbench")
set(MPMBENCH_INSTALLED_CMAKE "${CMAKE_INSTALL_LIBDIR}/cmake/mpmbench")
file(RELATIVE_PATH MPMBENCH_DATA_FROM_PROGRAM # a prefix stands before both
  "/prefix/${CMAKE_INSTALL_BINDIR}" "/prefix/${MPMBENCH_INSTALLED_DATA}")

configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/mpmbenchConfig.cmake.in" mpmbenchConfig.cmake
  INSTALL_DESTINATION "${MPMBENCH_INSTALLED_CMAKE}" PATH_VARS MPMBENCH_INSTALLED_DATA)
write_basic_package_version_file(mpmbenchConfigVersion.cmake COMPATIBILITY SameMinorVersion)

install(EXPORT mpmbench NAMESPACE mpm:: FILE mpmbenchTargets.cmake
  DESTINATION "${MPMBENCH_INSTALLED_CMAKE}" COMPONENT development)
install(FILES
  "${CMAKE_CURRENT_BINARY_DIR}/mpmbenchConfig.cmake" "${CMAKE_CURRENT_BINARY_DIR}/mpmbenchConfigVersion.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/Dependencies.cmake"
  DESTINATION "${MPMBENCH_INSTALLED_CMAKE}" COMPONENT development)

install(FILES README.md CHANGELOG.md CONTRIBUTING.md CODE_OF_CONDUCT.md SECURITY.md LICENSE CITATION.cff
  DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program)
install(DIRECTORY docs examples DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program)
# The licence goes with each package, where Debian looks for it.
foreach(package mpmbench.program libmpmbench-dev.development python3-mpmbench.python)
  string(REGEX MATCH "(.*)[.](.*)" whole "${package}")
  install(FILES LICENSE RENAME copyright
    DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${CMAKE_MATCH_1}" COMPONENT "${CMAKE_MATCH_2}")
endforeach()

# Where Debian's Python looks when the prefix is /usr, and what +mpmbench is for Octave.
install(DIRECTORY python/mpmbench DESTINATION lib/python3/dist-packages COMPONENT python PATTERN __pycache__ EXCLUDE)
install(DIRECTORY python/notebooks DESTINATION "${CMAKE_INSTALL_DOCDIR}/python" COMPONENT program)
install(DIRECTORY octave/+mpmbench DESTINATION "${MPMBENCH_INSTALLED_DATA}/octave" COMPONENT program)
