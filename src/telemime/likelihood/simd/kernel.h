// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/aligned_allocator.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "telemime/body/pose.h"
#include "telemime/likelihood/cues/reductions.h"
#include "telemime/likelihood/packed_model.h"
#include "telemime/likelihood/simd/simd_backend.h"
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
  SimdStage last_stage = SimdStage::count;
};

/// Memory that one thread works in, aligned for vectors. It grows with the image and with how large the
/// person is in it, and is used again: an evaluation allocates nothing once it has the size.
struct Workspace {
  static constexpr std::size_t kLanes = PackedSegment::kMostLanes + 64;
  static constexpr std::size_t kVertices = kSegmentCount * PackedSegment::kMostLanes + 64;
  static constexpr std::size_t kPoses = 16;
  static constexpr std::size_t kNumbers = 12 * kSegmentCount;

  alignas(64) float pose[kPoseSize][kPoses];      ///< pose numbers of a block, by lane
  alignas(64) float transform[kNumbers][kPoses];  ///< camera from segment, 12 numbers each, by lane
  alignas(64) float u[kVertices], v[kVertices], w[kVertices];  ///< the model's vertices, px and 1/m
  alignas(64) float line[18][kLanes];     ///< of a segment: four edges, depth plane and fold, a b c each
  alignas(64) float bend[kLanes];         ///< 1/z is plane + bend * min(fold, 0)
  alignas(64) std::int32_t tile[kLanes];  ///< first tile of a lane's quadrilateral
  alignas(64) float tile_x[kLanes], tile_y[kLanes];
  alignas(64) std::int32_t columns[kLanes], rows[kLanes];  ///< its tiles but one

  /// Tiles: bits of 1/z with the class in the lowest five; 0: nothing. One more pixel behind the last one is
  /// nearer than everything: it stands for those outside the image.
  hwy::AlignedFreeUniquePtr<std::uint32_t[]> depth;
  std::size_t pixels = 0;

  /// Contour points: px, 1/m; their pixels; what these show.
  hwy::AlignedFreeUniquePtr<float[]> sample_x, sample_y, sample_w, sample_nearest, sample_distance;
  hwy::AlignedFreeUniquePtr<std::int32_t[]> sample_pixel;
  std::size_t samples = 0;
  std::size_t capacity = 0;

  void fit(const TileGrid& grid);
  void grow_samples(std::size_t at_least);
};

/// Counts of one pose after the other; `observed` is left alone.
using Kernel = void (*)(const Batch& batch, std::span<const Pose> poses, std::span<Reductions> out,
                        Workspace& workspace);

struct InstructionSet {
  std::string_view name;  ///< "avx512", "avx2", "sse4", "ssse3", "neon", "portable"
  Kernel kernel = nullptr;
};

/// What this processor can run, the fastest first. Those with fused multiply-add (avx512, avx2, neon) give
/// the same bits, and so do the others.
std::vector<InstructionSet> instruction_sets();

}  // namespace telemime::simd
