# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=web -DFOLDER=... -DNPM=npm -P page_packages.cmake: the packages that SOURCE's lock file names, in
# FOLDER/copy. Their install scripts do not run.
cmake_minimum_required(VERSION 3.22)
set(copy "${FOLDER}/copy")
file(MAKE_DIRECTORY "${copy}")
file(COPY "${SOURCE}/package.json" "${SOURCE}/package-lock.json" DESTINATION "${copy}")
execute_process(
  COMMAND "${NPM}" ci --include=dev --ignore-scripts --no-audit --no-fund --no-update-notifier
  WORKING_DIRECTORY "${copy}" RESULT_VARIABLE failed OUTPUT_VARIABLE words ERROR_VARIABLE words)
if(failed)
  message("${words}")
  message(FATAL_ERROR "npm could not fetch the packages of the page (its words are above). It needs the network once. "
                      "To do without the page, configure with -DTELEMIME_WEB=OFF")
endif()
file(TOUCH "${FOLDER}/packages.stamp")
