# Build settings common to every target.

option(MPMBENCH_TESTS "Build the tests" ON)
option(MPMBENCH_WARNINGS_AS_ERRORS "Treat compiler warnings as errors" OFF)
option(MPMBENCH_PERF "Build the benchmarks of bench/perf (needs Google Benchmark)" OFF)
set(MPMBENCH_SANITIZERS "" CACHE STRING "Sanitizers to build with: address,undefined or thread")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

# Most of the time of a build goes into reading headers and instantiating Eigen. Sources that are compiled as one
# share that: 24 at a time take a third of the compiler's time away that 12 take, which take half of that of single ones.
# The price is that a change compiles its neighbours too, so the preset debug compiles each source by itself, and up to
# 2.2 GB of memory for a compiler, of which no more run at once than find 2. gcc's garbage collector looks through
# all that several times, a tenth of the compiler's time, unless it waits: until there are 1.5 GB, and half as much again.
set(CMAKE_UNITY_BUILD_BATCH_SIZE 24 CACHE STRING "Sources that are compiled as one, with CMAKE_UNITY_BUILD")
if(CMAKE_UNITY_BUILD)
  cmake_host_system_information(RESULT memory QUERY TOTAL_PHYSICAL_MEMORY)  # MiB
  math(EXPR compilers "(${memory} + 1023) / 2048")
  if(compilers LESS 1)
    set(compilers 1)
  endif()
  set_property(GLOBAL APPEND PROPERTY JOB_POOLS compile=${compilers})
  set(CMAKE_JOB_POOL_COMPILE compile)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    add_compile_options(--param=ggc-min-heapsize=1000000 --param=ggc-min-expand=50)  # kB, %
  endif()
endif()

# Carried by every target of the project, never by users' code.
add_library(mpm_build_flags INTERFACE)
target_compile_options(mpm_build_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow
  # False alarms of GCC 12 about Eigen's empty matrices and an empty std::optional, at all levels but -O3.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
  # No contraction: the same source gives the same bits with and without FMA hardware.
  -ffp-contract=off
  # What it warns of in a header, local types in a class, is in order in a source, and gcc takes sources for headers here.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage>
  $<$<BOOL:${MPMBENCH_WARNINGS_AS_ERRORS}>:-Werror>)
target_compile_definitions(mpm_build_flags INTERFACE EIGEN_DONT_PARALLELIZE)

if(MPMBENCH_SANITIZERS)
  # Every target, so that no allocation crosses from instrumented into plain code. A report ends the program.
  add_compile_options(-fsanitize=${MPMBENCH_SANITIZERS} -fno-sanitize-recover=all -fno-omit-frame-pointer -O1)
  add_link_options(-fsanitize=${MPMBENCH_SANITIZERS})
endif()
