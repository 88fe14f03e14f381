// SPDX-License-Identifier: Apache-2.0
#ifndef TELEMIME_CUDA  // cuda_device.cu is compiled in this file's place
#include "telemime/core/errors.h"
#include "telemime/likelihood/gpu/device.h"

namespace telemime::gpu {

std::unique_ptr<Device> make_cuda_device() {
  throw Error(ErrorKind::usage, "CUDA: " + cuda_missing());
}

std::string cuda_missing() {
  return "this program was built without CUDA";
}

}  // namespace telemime::gpu
#endif
