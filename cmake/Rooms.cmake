# A room is a top-level folder with one static library. Its include root is the repository root, so
# that an include names the room it comes from.

# What most sources include takes the compiler 1 to 2 s to read. It is read once for the rooms, and once for the
# tests. No source of a room relies on it: each is also compiled without it (tests/structure).
set(mpm_precompiled_std
  <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory> <optional> <string>
  <string_view> <utility> <vector>)
set(mpm_precompiled_rooms ${mpm_precompiled_std} <Eigen/Core> <fmt/format.h>)
set(mpm_precompiled_tests ${mpm_precompiled_std} <Eigen/Core> <catch2/catch.hpp>)

# mpm_room(<name> SOURCES <file>... [PUBLIC <library>...] [PRIVATE <library>...] [OWN_PRECOMPILED])
# OWN_PRECOMPILED: the compiler's options differ from those of the other rooms, so that theirs does not fit.
function(mpm_room name)
  cmake_parse_arguments(ROOM "OWN_PRECOMPILED" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(mpm_${name} STATIC ${ROOM_SOURCES})
  add_library(mpm::${name} ALIAS mpm_${name})
  target_include_directories(mpm_${name} PUBLIC "${PROJECT_SOURCE_DIR}")
  target_link_libraries(mpm_${name}
    PUBLIC ${ROOM_PUBLIC}
    PRIVATE mpm_build_flags ${ROOM_PRIVATE})
  target_compile_definitions(mpm_${name} PUBLIC EIGEN_DONT_PARALLELIZE)
  if(name STREQUAL plants OR ROOM_OWN_PRECOMPILED)
    target_precompile_headers(mpm_${name} PRIVATE ${mpm_precompiled_rooms})
  else()
    target_precompile_headers(mpm_${name} REUSE_FROM mpm_plants)
  endif()
endfunction()

# mpm_test(<name> SOURCES <file>... [LINK <library>...]): one Catch2 executable, one CTest entry a test case.
function(mpm_test name)
  cmake_parse_arguments(TEST "" "" "SOURCES;LINK" ${ARGN})
  add_executable(test_${name} ${TEST_SOURCES})
  target_link_libraries(test_${name} PRIVATE mpm_build_flags mpm_test_main ${TEST_LINK})
  target_precompile_headers(test_${name} REUSE_FROM mpm_test_main)
  catch_discover_tests(test_${name} TEST_PREFIX "${name}: " DISCOVERY_MODE PRE_TEST)
endfunction()
