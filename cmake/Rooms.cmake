# A room is a top-level folder with one static library. Its include root is the repository root, so
# that an include names the room it comes from.

# mpm_room(<name> SOURCES <file>... [PUBLIC <library>...] [PRIVATE <library>...])
function(mpm_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(mpm_${name} STATIC ${ROOM_SOURCES})
  add_library(mpm::${name} ALIAS mpm_${name})
  target_include_directories(mpm_${name} PUBLIC
    "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>" "$<INSTALL_INTERFACE:${MPMBENCH_INSTALLED_HEADERS}>")
  target_link_libraries(mpm_${name}
    PUBLIC ${ROOM_PUBLIC}
    PRIVATE "$<BUILD_INTERFACE:mpm_build_flags>" ${ROOM_PRIVATE})
  target_compile_definitions(mpm_${name} PUBLIC EIGEN_DONT_PARALLELIZE)
  target_compile_features(mpm_${name} PUBLIC cxx_std_20)
  set_target_properties(mpm_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS mpm_${name} EXPORT mpmbench COMPONENT development)
  install(DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" DESTINATION "${MPMBENCH_INSTALLED_HEADERS}" COMPONENT development
    FILES_MATCHING PATTERN "*.hpp" PATTERN perf EXCLUDE)
endfunction()

# mpm_test(<name> SOURCES <file>... [LINK <library>...]): one Catch2 executable, one CTest entry a test case.
function(mpm_test name)
  cmake_parse_arguments(TEST "" "" "SOURCES;LINK" ${ARGN})
  add_executable(test_${name} ${TEST_SOURCES})
  target_link_libraries(test_${name} PRIVATE mpm_build_flags mpm_test_main ${TEST_LINK})
  catch_discover_tests(test_${name} TEST_PREFIX "${name}: " DISCOVERY_MODE PRE_TEST)
endfunction()
