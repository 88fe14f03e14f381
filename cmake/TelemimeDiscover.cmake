# SPDX-License-Identifier: Apache-2.0
# telemime_discover(TARGET PREFIX [EACH] [PROPERTIES NAME VALUE...]): the tests of a program of GoogleTest as tests of ctest,
# PREFIX.SUITE for each suite: what a process costs before its first test (0.1 s with OpenCV) and what the tests of a
# suite share is then paid once. With EACH every test has a process of its own: where some are skipped while others run.
# This file is also the script that lists the suites when the program has been built: cmake -DPROGRAM=... -P.
if(CMAKE_SCRIPT_MODE_FILE)
  execute_process(COMMAND "${PROGRAM}" --gtest_list_tests OUTPUT_VARIABLE listed RESULT_VARIABLE failed TIMEOUT 60)
  if(failed)
    message(FATAL_ERROR "${PROGRAM} does not list its tests: ${failed}")
  endif()
  string(REGEX MATCHALL "\n[A-Za-z0-9_/]+\\." suites "\n${listed}")
  set(script)
  foreach(suite IN LISTS suites)
    string(REGEX REPLACE "^\n(.*)\\.$" "\\1" suite "${suite}")
    string(APPEND script "add_test([==[${PREFIX}.${suite}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${suite}.*]==])\n"
                         "set_tests_properties([==[${PREFIX}.${suite}]==] PROPERTIES ${PROPERTIES})\n")
  endforeach()
  file(WRITE "${FILE}" "${script}")
  return()
endif()

set(TELEMIME_DISCOVER "${CMAKE_CURRENT_LIST_FILE}")

function(telemime_discover target prefix)
  cmake_parse_arguments(DISCOVER "EACH" "" "PROPERTIES" ${ARGN})
  if(DISCOVER_EACH)
    gtest_discover_tests(${target} TEST_PREFIX "${prefix}." DISCOVERY_TIMEOUT 60 PROPERTIES ${DISCOVER_PROPERTIES})
    return()
  endif()
  set(properties)
  foreach(value IN LISTS DISCOVER_PROPERTIES)
    string(APPEND properties " [==[${value}]==]")
  endforeach()
  set(file "${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake")
  add_custom_command(TARGET ${target} POST_BUILD BYPRODUCTS "${file}" VERBATIM
                     COMMAND "${CMAKE_COMMAND}" "-DPROGRAM=$<TARGET_FILE:${target}>" "-DPREFIX=${prefix}"
                             "-DFILE=${file}" "-DPROPERTIES=${properties}" -P "${TELEMIME_DISCOVER}")
  file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake"
       "if(EXISTS \"${file}\")\n  include(\"${file}\")\nelse()\n  add_test(${prefix}.not_built ${target}_not_built)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake")
endfunction()
