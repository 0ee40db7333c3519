# `cpack` in the build folder makes three packages for Debian: the program with its studies, the Python package, and what
# one needs to build on the libraries.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The mpmbench developers <nobody@mpmbench.invalid>") # a form that dpkg's tools read; no address
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL program development python)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME mpmbench)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "gnuplot-nox, tzdata") # figures; time zones of records
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS libopenblas0-serial)

# The headers and libraries that Dependencies.cmake looks for, from the one list of packages.
file(STRINGS .ci/packages.txt packages REGEX "^[a-z0-9.+-]+ +build")
list(TRANSFORM packages REPLACE " .*" "")
list(JOIN packages ", " packages)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libmpmbench-dev)
# Its CMake file names the folder of the studies, which the program's package has.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "mpmbench (= ${PROJECT_VERSION}), ${packages}")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-mpmbench)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
  "mpmbench (= ${PROJECT_VERSION}), python3 (>= 3.11), python3-numpy, python3-pandas, python3-xarray, python3-netcdf4, python3-matplotlib")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
  "Random model-plant mismatches and unmeasured disturbances, closed loops of a range MPC, and how often methods\n that assess its model are right about them. With its studies, documents and examples.")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
  "mpmbench from Python: studies, methods that are functions, records as data frames, and figures.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Static libraries, headers and the CMake package mpmbench.")

include(CPack)
