// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/aligned_allocator.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "telemime/body/skeleton.h"
#include "telemime/likelihood/cues/reductions.h"
#include "telemime/likelihood/packed_model.h"
#include "telemime/likelihood/simd/simd_backend.h"
#include "telemime/likelihood/tiled_planes.h"

namespace telemime::simd {

/// Camera parameters of the kernel, px.
struct Pinhole {
  float fx = 0.0F, fy = 0.0F, cx = 0.0F, cy = 0.0F;
  bool operator==(const Pinhole&) const = default;
};

/// Inputs that are the same for all poses of a batch.
struct Batch {
  const PackedModel& model;
  const TiledPlanes& frame;
  Pinhole camera;
  Reduction terms = Reduction::all;
  SimdStage last_stage = SimdStage::count;
};

using LaneSet = PackedSegment::LaneSet;

/// Tiles from (left, top) to (right, bottom), inclusive.
struct TileRect {
  std::int32_t left, top, right, bottom;
};

/// A segment in the image. Coordinates of vertices are in tiles: pixels over 4.
struct Projection {
  TileRect tiles;  ///< tiles that it may touch: none, or at least 3 x 3
  bool behind;     ///< whether some vertices are not in front of the camera
};

/// Which triangles of a segment are drawn (in front of the camera) and which of them face it: the first and
/// the second of each lane's quadrilateral.
struct Facing {
  LaneSet front[2] = {};
  LaneSet known[2] = {};
  LaneSet drawn = {};   ///< quadrilaterals that are visible in the image
  LaneSet folded = {};  ///< those whose triangles lie in two planes
  LaneSet small = {};   ///< those of at most 2 x 2 tiles
  LaneSet narrow = {};  ///< those of `small` with one column
  LaneSet medium = {};  ///< those of at most 3 x 3 tiles that are not in `small`
};

/// A pose as the kernel reads it: camera from segment, by Segment. Three rows of the rotation, then the
/// translation (m).
using Placement = std::array<std::array<float, 12>, kSegmentCount>;

/// Segments by bit.
using SegmentSet = std::uint32_t;

/// What the poses before have left: segments that stay where they were are not drawn again.
struct Memory {
  std::shared_ptr<const void> model, frame;  ///< the contents that the rest is of
  Pinhole camera;
  Placement placed = {};  ///< the pose before
  Projection projection[kSegmentCount] = {};
  Facing facing[kSegmentCount];  ///< of those that are still
  SegmentSet still = 0;          ///< segments that are drawn in both planes of depths and counted here
  Reductions counts;             ///< of these
  /// Those whose contour points are the first `samples` of the workspace: all of `still`, or none. Points
  /// that they hide themselves are left out.
  SegmentSet sampled = 0;
  std::size_t samples = 0;  ///< a multiple of a tile's pixels
};

/// Working memory of one thread, aligned for vectors. It grows with the image and with the size of the person
/// in it and is reused: an evaluation allocates nothing once it is large enough.
struct Workspace {
  static constexpr std::size_t kLanes = PackedSegment::kMostLanes + 64;
  static constexpr std::size_t kVertices = kSegmentCount * PackedSegment::kMostLanes + 64;

  alignas(64) float u[kVertices], v[kVertices], w[kVertices];  ///< the model's vertices, px and 1/m
  alignas(64) float line[18][kLanes];     ///< four edges, depth plane and fold of a segment; a b c each
  alignas(64) float bend[kLanes];         ///< 1/z is plane + bend * min(fold, 0)
  alignas(64) std::int32_t tile[kLanes];  ///< first tile of a lane's quadrilateral
  alignas(64) float tile_x[kLanes], tile_y[kLanes];
  alignas(64) std::int32_t columns[kLanes], rows[kLanes];  ///< number of its tiles, minus one

  /// Tiles: bits of 1/z with the class in the lowest five; 0: nothing. An additional last pixel is nearer
  /// than everything: it represents those outside the image.
  hwy::AlignedFreeUniquePtr<std::uint32_t[]> depth;
  hwy::AlignedFreeUniquePtr<std::uint32_t[]> still_depth;  ///< the same of the segments that stay
  Memory memory;
  std::size_t pixels = 0;
  int grid_columns = 0;  ///< of the tiles; grids of as many pixels may differ in shape

  /// Contour points (tiles, 1/m), their pixels, and depth (1/m) and distance (units) of those pixels.
  hwy::AlignedFreeUniquePtr<float[]> sample_x, sample_y, sample_w, sample_nearest;
  hwy::AlignedFreeUniquePtr<std::int32_t[]> sample_pixel, sample_distance;
  std::size_t samples = 0;
  std::size_t capacity = 0;

  void fit(const TileGrid& grid);
  void grow_samples(std::size_t at_least);
};

/// Adds what it counts of one pose to `out`, which comes in as Reductions{}; does not set `observed`.
using Kernel = void (*)(const Batch& batch, const Placement& pose, Reductions& out, Workspace& workspace);

struct InstructionSet {
  std::string_view name;  ///< "avx512", "avx2", "sse4", "ssse3", "neon", "portable"
  Kernel kernel = nullptr;
};

/// Instruction sets that this processor can run, the fastest first. Those with fused multiply-add (avx512,
/// avx2, neon) give identical bits; so do the others among each other.
std::vector<InstructionSet> instruction_sets();

}  // namespace telemime::simd
