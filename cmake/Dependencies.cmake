# Third-party libraries, all from Debian 12 packages (.ci/packages.txt).

find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt 9 REQUIRED)
find_package(Boost 1.74 REQUIRED) # Boost.Math, headers only
find_package(CLI11 2.1 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(pugixml 1.13 REQUIRED)
find_package(utf8cpp 3.2 REQUIRED)
find_package(date 3.0 REQUIRED) # time stamps and zones of records
find_package(ICU 72 REQUIRED COMPONENTS i18n uc) # words in their dates: results/records/date_words.cpp
find_package(OpenSSL 3.0 REQUIRED COMPONENTS Crypto) # SHA-256 of archives
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED) # loops in the cache
find_package(OpenMP 4.5 REQUIRED COMPONENTS CXX) # part of the compiler

find_package(Ceres 2.1 REQUIRED) # analysis/identification/prediction_error_search.cpp

pkg_check_modules(IPOPT REQUIRED IMPORTED_TARGET ipopt)
pkg_check_modules(LIBZIP REQUIRED IMPORTED_TARGET libzip) # its CMake file asks for the programs as well
pkg_check_modules(TOMLPLUSPLUS REQUIRED IMPORTED_TARGET tomlplusplus)

enable_language(C) # FindHDF5 compiles a C program
set(HDF5_PREFER_PARALLEL OFF)
find_package(HDF5 1.10 REQUIRED COMPONENTS C HL)

find_package(SUNDIALS 6.4 REQUIRED COMPONENTS arkode cvode nvecserial sunmatrixdense sunlinsoldense)

if(MPMBENCH_PERF)
  find_package(benchmark 1.7 REQUIRED)
endif()

find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
add_library(random123 INTERFACE IMPORTED)
target_include_directories(random123 SYSTEM INTERFACE "${RANDOM123_INCLUDE_DIR}")

find_path(LIBSVM_INCLUDE_DIR libsvm/svm.h REQUIRED) # analysis/statistics/one_class_svm.cpp
find_library(LIBSVM_LIBRARY svm REQUIRED)
add_library(libsvm INTERFACE IMPORTED)
target_include_directories(libsvm SYSTEM INTERFACE "${LIBSVM_INCLUDE_DIR}")
target_link_libraries(libsvm INTERFACE "${LIBSVM_LIBRARY}")
