// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/all.h"

#include <algorithm>
#include <chrono>

#include "telemime/core/errors.h"
#include "telemime/core/text.h"
#include "telemime/likelihood/gpu/device_backend.h"
#include "telemime/likelihood/simd/simd_backend.h"

namespace telemime {
namespace {

std::string nothing_missing() {
  return {};
}

std::unique_ptr<Backend> simd(const BackendOptions& options) {
  return make_simd_backend({.threads = options.threads, .cues = options.cues});
}
std::unique_ptr<Backend> opencl(const BackendOptions& options) {
  return gpu::make_device_backend("opencl", gpu::make_opencl_device(), options.cues);
}
std::unique_ptr<Backend> cuda(const BackendOptions& options) {
  return gpu::make_device_backend("cuda", gpu::make_cuda_device(), options.cues);
}

// A driver that offers the processor itself as a device is never faster than simd.
std::unique_ptr<Backend> fastest(const BackendOptions& options) {
  const bool has_cuda = gpu::cuda_missing().empty();
  if (!has_cuda && !gpu::opencl_is_gpu()) {
    return simd(options);
  }
  try {
    return make_auto_backend(simd(options), has_cuda ? cuda(options) : opencl(options), options.seconds);
  } catch (const Error&) {  // the driver does not support the kernel
    return simd(options);
  }
}

}  // namespace

const std::array<BackendKind, kBackendCount> kBackends = {{
    {"simd", "vector instructions of the processor", simd, nothing_missing},
    {"opencl", "a GPU, or any device that has an OpenCL driver", opencl, gpu::opencl_missing},
    {"cuda", "an NVIDIA GPU whose driver has no OpenCL", cuda, gpu::cuda_missing},
    {"auto", "a GPU for batches that it evaluates faster, with the same counts; else simd", fastest,
     nothing_missing},
    {"scalar", "the reference: one exact z-buffered mesh after the other",
     [](const BackendOptions& options) { return make_scalar_backend(options.cues); }, nothing_missing},
}};

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::unique_ptr<Backend> make_backend(std::string_view name, const BackendOptions& options) {
  const auto kind = std::find_if(kBackends.begin(), kBackends.end(),
                                 [&](const BackendKind& candidate) { return candidate.name == name; });
  if (kind == kBackends.end()) {
    throw Error(ErrorKind::usage, "unknown back end " + std::string(name),
                "Choose one of: " + joined(kBackends, &BackendKind::name) + ".");
  }
  const std::string missing = kind->missing();
  if (!missing.empty()) {
    throw Error(ErrorKind::usage, "the back end " + std::string(name) + " cannot be used here: " + missing,
                "Choose another back end; simd, the default, runs everywhere.");
  }
  return kind->make(options);
}

}  // namespace telemime
