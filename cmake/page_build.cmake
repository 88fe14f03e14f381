# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=web -DFOLDER=... -DNPM=npm -P page_build.cmake: FOLDER/copy becomes SOURCE as it is now (its packages
# stay), and the page is built there, into FOLDER/copy/dist.
cmake_minimum_required(VERSION 3.22)
set(copy "${FOLDER}/copy")
file(GLOB old LIST_DIRECTORIES ON "${copy}/*")
list(FILTER old EXCLUDE REGEX "/node_modules$")
file(REMOVE_RECURSE ${old})
file(COPY "${SOURCE}/" DESTINATION "${copy}" PATTERN node_modules EXCLUDE PATTERN dist EXCLUDE)
execute_process(
  COMMAND "${CMAKE_COMMAND}" -E env --unset=NODE_ENV "${NPM}" run build --no-update-notifier
  WORKING_DIRECTORY "${copy}" RESULT_VARIABLE failed OUTPUT_VARIABLE words ERROR_VARIABLE words)
if(failed)
  message("${words}")
  message(FATAL_ERROR "the page could not be built (npm's words are above)")
endif()
