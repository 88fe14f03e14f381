# SPDX-License-Identifier: Apache-2.0
# The page of `telemime live` inside the program. telemime_page(TARGET) builds web/ with npm, in a copy of it in the
# build tree, and adds the files that come out to TARGET, as telemime/live/page_table.h has them.

set(TELEMIME_WEB AUTO CACHE STRING "Build the page of `telemime live` into the program: ON, OFF, or AUTO, if there is npm")
find_program(TELEMIME_NPM npm DOC "Node's package manager, for the page")
find_program(TELEMIME_NODE NAMES node nodejs DOC "Node, for the page")
if(TELEMIME_WEB STREQUAL "AUTO" AND NOT (TELEMIME_NPM AND TELEMIME_NODE))
  set(TELEMIME_WEB OFF)
endif()
if(TELEMIME_WEB)
  if(NOT TELEMIME_NPM OR NOT TELEMIME_NODE)
    message(FATAL_ERROR "The page of `telemime live` is built with npm, which is missing here. Install it "
                        "(scripts/deps.sh, or the packages nodejs and npm), or do without the page: -DTELEMIME_WEB=OFF")
  endif()
  execute_process(COMMAND "${TELEMIME_NODE}" --version OUTPUT_VARIABLE node_version OUTPUT_STRIP_TRAILING_WHITESPACE)
  string(REGEX REPLACE "^v" "" node_version "${node_version}")
  if(node_version VERSION_LESS 18.19)
    message(FATAL_ERROR "The page of `telemime live` needs Node 18.19 or newer; ${TELEMIME_NODE} is \"${node_version}\". "
                        "Install a newer one, or do without the page: -DTELEMIME_WEB=OFF")
  endif()
endif()
message(STATUS "Page: ${TELEMIME_WEB}")

function(telemime_page target)
  set(scripts "${CMAKE_CURRENT_FUNCTION_LIST_DIR}")
  set(table "${CMAKE_CURRENT_BINARY_DIR}/made/page_table.cpp")
  set(table_script "${scripts}/page_table.cmake")
  if(TELEMIME_WEB)
    set(source "${PROJECT_SOURCE_DIR}/web")
    set(folder "${PROJECT_BINARY_DIR}/web")
    # Folder by folder: a developer's node_modules has too many files to look through at each build.
    file(GLOB entries CONFIGURE_DEPENDS "${source}/*")
    list(FILTER entries EXCLUDE REGEX "/(node_modules|dist)$")
    set(sources)
    foreach(entry IN LISTS entries)
      if(IS_DIRECTORY "${entry}")
        file(GLOB_RECURSE found CONFIGURE_DEPENDS "${entry}/*")
        list(APPEND sources ${found})
      else()
        list(APPEND sources "${entry}")
      endif()
    endforeach()
    string(SHA256 names "${sources}")  # in the command: it must run again when a file is gone, too
    add_custom_command(
      OUTPUT "${folder}/packages.stamp"
      COMMAND "${CMAKE_COMMAND}" "-DSOURCE=${source}" "-DFOLDER=${folder}" "-DNPM=${TELEMIME_NPM}"
              -P "${scripts}/page_packages.cmake"
      DEPENDS "${source}/package-lock.json" "${scripts}/page_packages.cmake"
      COMMENT "Fetching the packages of the page"
      VERBATIM)
    add_custom_command(
      OUTPUT "${table}"
      COMMAND "${CMAKE_COMMAND}" "-DSOURCE=${source}" "-DFOLDER=${folder}" "-DNPM=${TELEMIME_NPM}"
              "-DNAMES=${names}" -P "${scripts}/page_build.cmake"
      COMMAND "${CMAKE_COMMAND}" "-DFOLDER=${folder}/copy/dist" "-DTABLE=${table}" -P "${table_script}"
      DEPENDS "${folder}/packages.stamp" ${sources} "${scripts}/page_build.cmake" "${table_script}"
      COMMENT "Building the page"
      VERBATIM)
  else()
    set(folder "${scripts}/page_missing")
    add_custom_command(
      OUTPUT "${table}"
      COMMAND "${CMAKE_COMMAND}" "-DFOLDER=${folder}" "-DTABLE=${table}" -P "${table_script}"
      DEPENDS "${folder}/index.html" "${table_script}"
      COMMENT "Putting a note in the place of the page"
      VERBATIM)
  endif()
  target_sources(${target} PRIVATE "${table}")
  set_source_files_properties("${table}" PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
