# MPMBENCH_SOURCE_REVISION: the commit that is configured, "+" after it when tracked files differ from it.

set(MPMBENCH_SOURCE_REVISION unknown)
find_program(MPMBENCH_GIT git)
if(MPMBENCH_GIT)
  execute_process(
    COMMAND "${MPMBENCH_GIT}" describe --always --dirty=+ --abbrev=12 --exclude=*
    WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
    OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(MPMBENCH_SOURCE_REVISION "${revision}")
  endif()
  # A new commit configures again, so that the number stays true.
  if(EXISTS "${PROJECT_SOURCE_DIR}/.git/logs/HEAD")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/.git/logs/HEAD")
  endif()
endif()
