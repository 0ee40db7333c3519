# mpm_embed(<room> <file> <constant>): makes the text of a file of this folder, after an empty line, the value of
# `extern const char* const` <constant>, which the header of the same name declares. The file stays what it is for
# editors and linters (page.js, page.css); the build makes a source of it, again when it changes.

if(CMAKE_SCRIPT_MODE_FILE) # the step of the build: -DTEXT=... -DHEADER=... -DCONSTANT=... -DSOURCE=...
  file(READ "${TEXT}" text)
  if(text MATCHES "\\)text\"")
    message(FATAL_ERROR "${TEXT}: found )text\", which ends the text in C++; allowed: anything else")
  endif()
  file(WRITE "${SOURCE}" "#include \"${HEADER}\"\n\n"
    "const char* const mpm::${CONSTANT} = R\"text(\n${text})text\";\n")
  return()
endif()

function(mpm_embed room file constant)
  set(text "${CMAKE_CURRENT_SOURCE_DIR}/${file}")
  set(source "${CMAKE_CURRENT_BINARY_DIR}/${file}.cpp")
  set(script "${PROJECT_SOURCE_DIR}/cmake/EmbedText.cmake")
  cmake_path(REPLACE_EXTENSION file .hpp OUTPUT_VARIABLE header)
  add_custom_command(OUTPUT "${source}"
    COMMAND "${CMAKE_COMMAND}" "-DTEXT=${text}" "-DHEADER=${room}/${header}" "-DCONSTANT=${constant}" "-DSOURCE=${source}"
      -P "${script}"
    DEPENDS "${text}" "${script}"
    COMMENT "Embedding ${room}/${file}" VERBATIM)
  target_sources(mpm_${room} PRIVATE "${source}")
  set_source_files_properties("${source}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
