# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` lays down: the program, every module as a static library, headers, data, and a package for
# find_package(telemime). Users link telemime::telemime (all modules) or one module, telemime::body.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(modules GLOBAL PROPERTY TELEMIME_MODULES)
add_library(telemime_all INTERFACE)
add_library(telemime::telemime ALIAS telemime_all)
set_target_properties(telemime_all PROPERTIES EXPORT_NAME telemime)
target_link_libraries(telemime_all INTERFACE ${modules})

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/telemime")
set(doc_dir "${CMAKE_INSTALL_DATADIR}/doc/telemime")

# The component "program": what people use.
if(TARGET telemime)
  install(TARGETS telemime RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT program)
  install(DIRECTORY "${PROJECT_BINARY_DIR}/avatars/" DESTINATION "${CMAKE_INSTALL_DATADIR}/telemime/avatars"
          COMPONENT program)
  install(DIRECTORY "${PROJECT_BINARY_DIR}/reference/man1" DESTINATION "${CMAKE_INSTALL_MANDIR}" COMPONENT program)
  install(FILES "${PROJECT_BINARY_DIR}/reference/completions/telemime"
          DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" COMPONENT program)
  install(FILES "${PROJECT_SOURCE_DIR}/cmake/package/telemime.desktop"
          DESTINATION "${CMAKE_INSTALL_DATADIR}/applications" COMPONENT program)
  install(FILES "${PROJECT_SOURCE_DIR}/web/public/icon.svg" RENAME telemime.svg
          DESTINATION "${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps" COMPONENT program)
endif()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/data/" DESTINATION "${CMAKE_INSTALL_DATADIR}/telemime" COMPONENT program)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/integrations/blender" DESTINATION "${CMAKE_INSTALL_DATADIR}/telemime"
        COMPONENT program FILES_MATCHING PATTERN "*.py")
if(TELEMIME_MODELS)
  install(DIRECTORY "${PROJECT_BINARY_DIR}/models/" DESTINATION "${CMAKE_INSTALL_DATADIR}/telemime/models"
          COMPONENT program FILES_MATCHING PATTERN "*.tflite")
endif()
install(FILES "${PROJECT_SOURCE_DIR}/NOTICE" DESTINATION "${doc_dir}" COMPONENT program)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${doc_dir}" COMPONENT licence)

# The component "development": the library.
install(TARGETS ${modules} telemime_all EXPORT telemime ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
        COMPONENT development)
install(EXPORT telemime NAMESPACE telemime:: FILE telemimeTargets.cmake DESTINATION "${package_dir}"
        COMPONENT development)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/src/telemime" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT development
        FILES_MATCHING PATTERN "*.h" PATTERN "testing*.h" EXCLUDE)
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/telemimeConfig.cmake.in"
                              "${PROJECT_BINARY_DIR}/telemimeConfig.cmake" INSTALL_DESTINATION "${package_dir}"
                              PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/telemimeConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/telemimeConfig.cmake" "${PROJECT_BINARY_DIR}/telemimeConfigVersion.cmake"
              "${PROJECT_SOURCE_DIR}/cmake/FindOpenCV.cmake" "${PROJECT_SOURCE_DIR}/cmake/FindXNNPACK.cmake"
        DESTINATION "${package_dir}" COMPONENT development)
