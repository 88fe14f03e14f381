# SPDX-License-Identifier: Apache-2.0
# find_package(OpenCV VERSION COMPONENTS core imgproc ...): one target opencv_COMPONENT each, OpenCV_LIBS and
# OpenCV_INCLUDE_DIRS. OpenCV's own package file asks for every module that it was built with: Debian's needs
# libopencv-dev, which installs some fifty packages more than the modules that are used here.
find_path(OpenCV_INCLUDE_DIRS opencv2/core/version.hpp PATH_SUFFIXES opencv4)
set(version 0)
if(OpenCV_INCLUDE_DIRS)
  file(READ "${OpenCV_INCLUDE_DIRS}/opencv2/core/version.hpp" text)
  string(REGEX MATCH "CV_VERSION_MAJOR +([0-9]+).*CV_VERSION_MINOR +([0-9]+)" text "${text}")
  set(version "${CMAKE_MATCH_1}.${CMAKE_MATCH_2}")
endif()

set(OpenCV_LIBS)
foreach(component IN LISTS OpenCV_FIND_COMPONENTS)
  find_library(OpenCV_${component}_LIBRARY opencv_${component})
  if(OpenCV_${component}_LIBRARY AND EXISTS "${OpenCV_INCLUDE_DIRS}/opencv2/${component}.hpp")
    set(OpenCV_${component}_FOUND TRUE)
    if(NOT TARGET opencv_${component})
      add_library(opencv_${component} SHARED IMPORTED GLOBAL)
      set_target_properties(opencv_${component} PROPERTIES IMPORTED_LOCATION "${OpenCV_${component}_LIBRARY}"
                                                           INTERFACE_INCLUDE_DIRECTORIES "${OpenCV_INCLUDE_DIRS}")
    endif()
    list(APPEND OpenCV_LIBS opencv_${component})
  endif()
  mark_as_advanced(OpenCV_${component}_LIBRARY)
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCV REQUIRED_VARS OpenCV_INCLUDE_DIRS VERSION_VAR version HANDLE_COMPONENTS)
