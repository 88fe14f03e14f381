# SPDX-License-Identifier: Apache-2.0
# Debian packages by cpack: `telemime`, which is the component "program"; `libtelemime-dev`, the component "development";
# and `python3-telemime`, the component "python". They are made of a build that has everything: pages and models.

# The version is that of project(); the pages' package.json, Blender's add-on and the newest section of the changelog repeat it.
file(STRINGS "${PROJECT_SOURCE_DIR}/integrations/blender/telemime.py" add_on REGEX "\"version\": \\([0-9, ]+\\)")
string(REGEX REPLACE ".*\"version\": \\(([0-9]+), ([0-9]+), ([0-9]+)\\).*" "\\1.\\2.\\3" add_on "${add_on}")
file(READ "${PROJECT_SOURCE_DIR}/package.json" page)
string(JSON page_version GET "${page}" version)
file(STRINGS "${PROJECT_SOURCE_DIR}/CHANGELOG.md" released REGEX "^## \\[[0-9.]+\\] - [0-9-]+$")
list(GET released 0 released)
string(REGEX MATCH "\\[(.*)\\] - (.*)" released "${released}")
set(release_date "${CMAKE_MATCH_2}")
set(versions "${page_version}" "${add_on}" "${CMAKE_MATCH_1}")
list(REMOVE_DUPLICATES versions)
if(NOT versions STREQUAL PROJECT_VERSION)
  message(FATAL_ERROR "The versions differ: ${PROJECT_VERSION} in CMakeLists.txt, ${page_version} in package.json, "
                      "${add_on} in integrations/blender/telemime.py, ${CMAKE_MATCH_1} in CHANGELOG.md. docs/releasing.md says how "
                      "to set them")
endif()

if(NOT TELEMIME_PROGRAM OR NOT TELEMIME_WEB OR NOT TELEMIME_MODELS)
  return()
endif()

# What Debian wants below /usr/share/doc: the licences and the changes.
set(package_doc "${PROJECT_BINARY_DIR}/package_doc")
execute_process(COMMAND date -u -R -d "${release_date}" OUTPUT_VARIABLE release_date OUTPUT_STRIP_TRAILING_WHITESPACE)
set(CPACK_PACKAGE_CONTACT "Telemime authors <maintainers@telemime.example>")
configure_file("${PROJECT_SOURCE_DIR}/cmake/package/changelog.in" "${package_doc}/changelog" @ONLY)
configure_file("${PROJECT_SOURCE_DIR}/CHANGELOG.md" "${package_doc}/NEWS" COPYONLY)
execute_process(COMMAND gzip -9nf changelog NEWS WORKING_DIRECTORY "${package_doc}")
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME telemime)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libtelemime-dev)
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-telemime)
if(TARGET _telemime)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER "${component}" component_name)
  install(FILES "${package_doc}/changelog.gz" "${package_doc}/NEWS.gz" "${PROJECT_BINARY_DIR}/copyright" COMPONENT ${component}
          DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${component_name}_PACKAGE_NAME}")
endforeach()

# A static library needs what it is linked with where programs are linked with it.
file(STRINGS "${PROJECT_SOURCE_DIR}/scripts/packages.txt" needs REGEX "^build (lib|nlohmann|ocl|opencl|pkg-config)")
list(FILTER needs EXCLUDE REGEX "libcli11-dev|libmeshoptimizer-dev|libmosquitto-dev")
list(TRANSFORM needs REPLACE "^build ([^ ]+).*" "\\1")
list(JOIN needs ", " needs)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_THREADS 0)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE gzip)  # the models hardly shrink, and xz takes half a minute

set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION video)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS opencv-data)  # the face detector's file: no library
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "firefox-esr | chromium | www-browser, xdg-utils")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS mosquitto)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION
    "Telemime follows a person's body, hands, fingers and face in an ordinary webcam
or video, without markers, on the processor alone. A page in the browser shows
an avatar that moves along. The motion goes to other programs by VMC, WebSocket
or MPEG-4 BAP, and to files as BVH, glTF, VRMA, TRC, CSV and JSON.
.
The package contains the neural networks and the pages: nothing is fetched when
the program runs. Meetings need a Mosquitto broker, the package mosquitto.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "telemime (= ${PROJECT_VERSION}), ${needs}")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
    "The static libraries of Telemime, their headers, and its CMake package:
find_package(telemime) gives the target telemime::telemime.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
if(TARGET _telemime)
  math(EXPR next_minor "${TELEMIME_PYTHON_MINOR} + 1")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "telemime (= ${PROJECT_VERSION}), python3 (>= 3.${TELEMIME_PYTHON_MINOR}), \
python3 (<< 3.${next_minor}), python3-numpy")
set(python_scripts "${PROJECT_SOURCE_DIR}/cmake/package/python3-telemime")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${python_scripts}/postinst;${python_scripts}/prerm")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)  # they are executable, whatever the checkout's files are
set(CPACK_DEBIAN_PYTHON_DESCRIPTION
    "The tracker of Telemime for Python: the frames of a video, a camera or arrays
of NumPy give poses, joints, hands and faces.")
include(CPack)
