// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "telemime/likelihood/device_times.h"

namespace telemime::gpu {

/// Limits of the kernel: its threads work in 48 KiB of shared memory, which every device of the last ten
/// years has.
inline constexpr int kGroupSize = 128;
inline constexpr int kBandPixels = 8192;
inline constexpr std::size_t kMostVertices = 1024;
/// Poses of one launch.
inline constexpr std::size_t kMostPoses = std::size_t{1} << 16;

/// The kernel's own structs, number for number (evaluate.cl).
struct FrameNumbers {
  float fx = 0.0F, fy = 0.0F, cx = 0.0F, cy = 0.0F;
  std::int32_t width = 0, height = 0;
  std::int32_t vertices = 0;
  std::int32_t terms = 0;
  float neck[3] = {};
  float shoulder[6] = {};
  float lift = 0.0F, reach = 0.0F;
  float upper_arm[2] = {};
  float forearm[2] = {};
};
struct PoseCounts {
  std::int32_t model[3];  ///< by surface class
  std::int32_t both[3];
  std::int32_t points;
  float sum;
};

/// What goes to a device.
struct DeviceInput {
  FrameNumbers frame;
  std::vector<float> vertices;       ///< x of all, y of all, z of all
  std::vector<std::uint32_t> words;  ///< by lane: class, marks, segment, stride (evaluate.cl)
  std::vector<std::int32_t> beside;  ///< by lane: the quadrilateral on its side that comes before
  std::vector<float> poses;          ///< 23 numbers each
  std::span<const std::uint8_t> labels;
  std::span<const float> distance;
};

/// A processor beside the processor. Not to be used by two threads at a time. Throws Error(usage) when it
/// fails, with the driver's words.
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;
  /// Evaluates input.poses.size() / 23 poses, at most kMostPoses; one PoseCounts each.
  virtual DeviceTimes run(const DeviceInput& input, std::span<PoseCounts> counts) = 0;
};

/// The first GPU that an OpenCL driver offers, or else whatever device it offers.
std::unique_ptr<Device> make_opencl_device();
/// Why there is none, in words; empty: there is one.
std::string opencl_missing();
/// Whether make_opencl_device() would give a GPU.
bool opencl_is_gpu();

/// The first NVIDIA GPU, the same kernel through CUDA.
std::unique_ptr<Device> make_cuda_device();
std::string cuda_missing();

}  // namespace telemime::gpu
