// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/errors.h"
#include "telemime/likelihood/gpu/device.h"

#ifdef TELEMIME_OPENCL
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120
#include <CL/opencl.hpp>

#include "telemime/likelihood/gpu/kernel_source.h"
#endif

namespace telemime::gpu {

#ifdef TELEMIME_OPENCL
namespace {

Error failed(const std::string& what) {
  return {ErrorKind::usage, "OpenCL: " + what, "Use the back end simd, or look at the device's driver."};
}

bool is_gpu(const cl::Device& device) {
  return (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) != 0;
}

// The first GPU, else the first device, with enough memory for a group.
std::vector<cl::Device> usable_devices() {
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {  // no driver is installed
    return {};
  }
  std::vector<cl::Device> gpus;
  std::vector<cl::Device> others;
  for (const cl::Platform& platform : platforms) {
    std::vector<cl::Device> devices;
    try {
      platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    } catch (const cl::Error&) {  // the driver has no device
      continue;
    }
    for (const cl::Device& device : devices) {
      try {
        if (device.getInfo<CL_DEVICE_AVAILABLE>() == CL_TRUE &&
            device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>() >= 48U * 1024U &&
            device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>() >= static_cast<std::size_t>(kGroupSize)) {
          (is_gpu(device) ? gpus : others).push_back(device);
        }
      } catch (const cl::Error&) {  // the device does not respond
        continue;
      }
    }
  }
  gpus.insert(gpus.end(), others.begin(), others.end());
  return gpus;
}

double seconds(const cl::Event& event) {
  return 1e-9 * static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                    event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
}

// Memory on the device that grows and is reused.
class Buffer {
 public:
  Buffer(const cl::Context& context, cl_mem_flags flags) : context_(context), flags_(flags) {}

  const cl::Buffer& of_size(std::size_t bytes) {
    if (bytes > size_) {
      size_ = 0;
      buffer_ = cl::Buffer(context_, flags_, bytes);
      size_ = bytes;
    }
    return buffer_;
  }

 private:
  cl::Context context_;
  cl_mem_flags flags_;
  std::size_t size_ = 0;
  cl::Buffer buffer_;
};

class OpenClDevice final : public Device {
 public:
  explicit OpenClDevice(const cl::Device& device)
      : device_(device), context_(device), queue_(context_, device, CL_QUEUE_PROFILING_ENABLE) {
    cl::Program program(context_, std::string(kOpenClSource));
    const std::string options = "-cl-std=CL1.2 -DGROUP_SIZE=" + std::to_string(kGroupSize) +
                                " -DBAND_PIXELS=" + std::to_string(kBandPixels) +
                                " -DMOST_VERTICES=" + std::to_string(kMostVertices);
    try {
      program.build({device}, options.c_str());
    } catch (const cl::Error&) {
      throw failed("the kernel could not be compiled: " + program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device));
    }
    kernel_ = cl::Kernel(program, "evaluate_poses");
  }

  DeviceTimes run(const DeviceInput& input, std::span<PoseCounts> counts) override {
    try {
      return run_checked(input, counts);
    } catch (const cl::Error& error) {
      clFinish(queue_());  // pending writes still read the caller's memory
      throw failed(std::string(error.what()) + " failed with " + std::to_string(error.err()));
    }
  }

 private:
  template <typename T>
  void upload(cl_uint argument, Buffer& buffer, std::span<const T> data) {
    const cl::Buffer& memory = buffer.of_size(data.size_bytes());
    queue_.enqueueWriteBuffer(memory, CL_FALSE, 0, data.size_bytes(), data.data(), nullptr,
                              &uploads_.emplace_back());
    kernel_.setArg(argument, memory);
  }

  DeviceTimes run_checked(const DeviceInput& input, std::span<PoseCounts> counts) {
    uploads_.clear();
    upload<float>(0, poses_, input.poses);
    upload<float>(1, vertices_, input.vertices);
    upload<std::uint32_t>(2, words_, input.words);
    upload<std::int32_t>(3, beside_, input.beside);
    upload<FrameNumbers>(4, frame_, {&input.frame, 1});
    upload<std::uint8_t>(5, labels_, input.labels);
    upload<float>(6, distance_, input.distance);
    const cl::Buffer& out = counts_.of_size(counts.size_bytes());
    kernel_.setArg(7, out);
    cl::Event launched;
    queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(counts.size() * kGroupSize),
                                cl::NDRange(kGroupSize), nullptr, &launched);
    cl::Event read;
    queue_.enqueueReadBuffer(out, CL_TRUE, 0, counts.size_bytes(), counts.data(), nullptr, &read);
    DeviceTimes times;
    for (const cl::Event& event : uploads_) {
      times.upload += seconds(event);
    }
    times.kernel = seconds(launched);
    times.download = seconds(read);
    return times;
  }

  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  cl::Kernel kernel_;
  Buffer poses_{context_, CL_MEM_READ_ONLY}, vertices_{context_, CL_MEM_READ_ONLY},
      words_{context_, CL_MEM_READ_ONLY}, beside_{context_, CL_MEM_READ_ONLY},
      frame_{context_, CL_MEM_READ_ONLY}, labels_{context_, CL_MEM_READ_ONLY},
      distance_{context_, CL_MEM_READ_ONLY}, counts_{context_, CL_MEM_WRITE_ONLY};
  std::vector<cl::Event> uploads_;
};

}  // namespace

std::unique_ptr<Device> make_opencl_device() {
  const std::vector<cl::Device> devices = usable_devices();
  if (devices.empty()) {
    throw failed(opencl_missing());
  }
  try {
    return std::make_unique<OpenClDevice>(devices.front());
  } catch (const cl::Error& error) {
    throw failed(std::string(error.what()) + " failed with " + std::to_string(error.err()));
  }
}

std::string opencl_missing() {
  return usable_devices().empty() ? "no OpenCL driver offers a device (for the processor: pocl-opencl-icd)"
                                  : std::string();
}

bool opencl_is_gpu() {
  const std::vector<cl::Device> devices = usable_devices();
  return !devices.empty() && is_gpu(devices.front());
}
#else
std::unique_ptr<Device> make_opencl_device() {
  throw Error(ErrorKind::usage, "OpenCL: " + opencl_missing());
}

std::string opencl_missing() {
  return "this program was built without OpenCL";
}

bool opencl_is_gpu() {
  return false;
}
#endif

}  // namespace telemime::gpu
