# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=... -DPARTS=web -DFOLDER=... -DNPM=npm -P page_build.cmake: copies the PARTS of the repository SOURCE to
# FOLDER/copy, beside their packages, and builds the pages there, into FOLDER/copy/web/dist.
cmake_minimum_required(VERSION 3.22)
set(copy "${FOLDER}/copy")
file(REMOVE_RECURSE "${copy}/web" "${copy}/meeting")
foreach(part IN LISTS PARTS)
  file(COPY "${SOURCE}/${part}/" DESTINATION "${copy}/${part}" PATTERN dist EXCLUDE)
endforeach()
set(meeting OFF)
if("meeting/web" IN_LIST PARTS)
  set(meeting ON)
endif()
execute_process(
  COMMAND "${CMAKE_COMMAND}" -E env --unset=NODE_ENV TELEMIME_MEETING=${meeting} "${NPM}" run build --no-update-notifier
  WORKING_DIRECTORY "${copy}" RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(failed)
  message("${output}")
  message(FATAL_ERROR "the pages could not be built (see the output of npm above)")
endif()
