# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=... -DFOLDER=... -DNPM=npm -DKINDS=--include=dev -P page_packages.cmake: the packages that SOURCE's lock
# file names, in FOLDER/copy; with KINDS --omit=dev those alone that programs use. Their install scripts do not run.
cmake_minimum_required(VERSION 3.22)
set(copy "${FOLDER}/copy")
file(MAKE_DIRECTORY "${copy}")
file(COPY "${SOURCE}/package.json" "${SOURCE}/package-lock.json" DESTINATION "${copy}")
execute_process(
  COMMAND "${NPM}" ci ${KINDS} --ignore-scripts --no-audit --no-fund --no-update-notifier
  WORKING_DIRECTORY "${copy}" RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(failed)
  message("${output}")
  message(FATAL_ERROR "npm could not download the packages of the pages and models (see its output above). It needs the "
                      "network once. To build without them, configure with -DTELEMIME_WEB=OFF -DTELEMIME_MODELS=OFF")
endif()
file(TOUCH "${FOLDER}/packages.stamp")
