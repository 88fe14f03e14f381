# SPDX-License-Identifier: Apache-2.0
# What the back ends for devices need. None of it is needed otherwise: where something is missing, the back end is left
# out and says so at run time.

set(TELEMIME_HAVE_OPENCL OFF)
find_package(OpenCL QUIET)
find_path(TELEMIME_OPENCL_HPP CL/opencl.hpp)
if(OpenCL_FOUND AND TELEMIME_OPENCL_HPP)
  set(TELEMIME_HAVE_OPENCL ON)
endif()
message(STATUS "Back end opencl: ${TELEMIME_HAVE_OPENCL}")

set(TELEMIME_HAVE_CUDA OFF)
if(TELEMIME_CUDA)
  find_package(CUDAToolkit 12 QUIET)  # the first with C++20
  if(CUDAToolkit_FOUND AND CUDAToolkit_NVCC_EXECUTABLE AND TARGET CUDA::cudart_static)
    set(TELEMIME_HAVE_CUDA ON)
  endif()
endif()
message(STATUS "Back end cuda: ${TELEMIME_HAVE_CUDA}")
