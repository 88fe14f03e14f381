// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "telemime/body/pose.h"
#include "telemime/cues/reductions.h"
#include "telemime/likelihood/packed_model.h"
#include "telemime/likelihood/tiled_planes.h"

namespace telemime::simd {

/// A camera's numbers as the kernel takes them, px.
struct Pinhole {
  float fx = 0.0F, fy = 0.0F, cx = 0.0F, cy = 0.0F;
};

/// What a batch is evaluated against.
struct Batch {
  const PackedModel& model;
  const TiledPlanes& frame;
  Pinhole camera;
  Reduction terms = Reduction::all;
};

/// Memory that one thread works in. It grows with the image and is used again: an evaluation allocates nothing
/// once it has the size. Arrays are aligned by hand: `aligned` gives the first 64-byte boundary.
struct Workspace {
  static constexpr std::size_t kLanes = PackedSegment::kMostLanes + 64;
  static constexpr std::size_t kPoses = 16;
  static constexpr std::size_t kNumbers = 12 * kSegmentCount;

  alignas(64) float pose[23][kPoses];               ///< pose numbers of a block, by lane
  alignas(64) float transform[kNumbers][kPoses];    ///< camera from segment, 12 numbers each, by lane
  alignas(64) float u[kLanes], v[kLanes], w[kLanes];  ///< a segment's vertices, px and 1/m
  alignas(64) float line[15][kLanes];               ///< four edges and the depth plane, a b c each, by lane
  alignas(64) std::int32_t tile[kLanes];            ///< first tile of a lane's quadrilateral
  alignas(64) float tile_x[kLanes], tile_y[kLanes];
  alignas(64) std::int32_t columns[kLanes], rows[kLanes];  ///< its tiles but one

  std::vector<std::uint32_t> depth_memory;
  std::uint32_t* depth = nullptr;  ///< tiles: bits of 1/z with the class in the lowest five; 0: nothing
  std::size_t depth_size = 0;
  int left = 0, top = 0, right = 0, bottom = 0;  ///< tiles that hold something

  std::vector<float> samples;  ///< contour points: x, y, w, `capacity` each
  std::size_t capacity = 0;
  std::size_t count = 0;

  void fit(const TileGrid& grid);
  void grow_samples(std::size_t capacity_at_least);
};

/// Counts of one pose after the other; `observed` is left alone.
using Kernel = void (*)(const Batch& batch, std::span<const Pose> poses, std::span<Reductions> out,
                        Workspace& workspace);

struct InstructionSet {
  std::string_view name;  ///< "avx512", "avx2", "sse4", "ssse3", "neon", "portable"
  Kernel kernel = nullptr;
};

/// What this processor can run, the fastest first. All give the same bits.
std::vector<InstructionSet> instruction_sets();

}  // namespace telemime::simd
