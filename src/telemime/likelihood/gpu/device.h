// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace telemime {

/// Where the time of a batch on a device went, s.
struct DeviceTimes {
  double upload = 0.0;    ///< poses, frame and model to the device
  double kernel = 0.0;    ///< counting there
  double download = 0.0;  ///< counts back
};

/// Distances of the skeleton (m, body frame; see Body), in the layout of the kernel's Frame.
struct PackedSkeleton {
  std::array<float, 3> neck_from_root{};
  std::array<std::array<float, 3>, 2> shoulder_from_root{};  ///< with hanging arms
  float clavicle_lift = 0.0F;
  float clavicle_reach = 0.0F;
  std::array<float, 2> upper_arm{};
  std::array<float, 2> forearm{};
  bool operator==(const PackedSkeleton&) const = default;
};

}  // namespace telemime

namespace telemime::gpu {

/// Limits of the kernel: its threads work in 48 KiB of shared memory, which every GPU since 2013 has.
inline constexpr int kGroupSize = 128;
inline constexpr int kBandPixels = 7936;
inline constexpr std::size_t kMostVertices = 1024;
/// Most poses of one launch.
inline constexpr std::size_t kMostPoses = std::size_t{1} << 16;

/// Same layout as the structs of the kernel (evaluate.cl).
struct FrameNumbers {
  float fx = 0.0F, fy = 0.0F, cx = 0.0F, cy = 0.0F;
  std::int32_t width = 0, height = 0;
  std::int32_t vertices = 0;
  std::int32_t terms = 0;
  PackedSkeleton skeleton;
};
struct PoseCounts {
  std::int32_t model[3];  ///< by surface class
  std::int32_t both[3];
  std::int32_t points;
  float sum;
};

/// Input of one launch.
struct DeviceInput {
  FrameNumbers frame;
  std::vector<float> vertices;       ///< x of all, y of all, z of all
  std::vector<std::uint32_t> words;  ///< by lane: class, marks, segment, stride (evaluate.cl)
  std::vector<std::int32_t> beside;  ///< by lane: the quadrilateral on its side that comes before
  std::vector<float> poses;          ///< 23 numbers each
  std::span<const std::uint8_t> labels;
  std::span<const float> distance;
};

/// A device that runs the kernel. Not to be used by two threads at a time. Failures throw Error(usage) with
/// the driver's message.
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;
  /// Evaluates input.poses.size() / 23 poses, at most kMostPoses; one PoseCounts each.
  virtual DeviceTimes run(const DeviceInput& input, std::span<PoseCounts> counts) = 0;
};

/// The first GPU that an OpenCL driver offers; without a GPU the first device of any kind.
std::unique_ptr<Device> make_opencl_device();
/// Why there is no such device, for messages; empty: there is one.
std::string opencl_missing();
/// Whether make_opencl_device() would give a GPU.
bool opencl_is_gpu();

/// The first NVIDIA GPU; runs the same kernel through CUDA.
std::unique_ptr<Device> make_cuda_device();
std::string cuda_missing();

}  // namespace telemime::gpu
