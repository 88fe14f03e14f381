// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/simd/kernel.h"

#include <algorithm>
#include <bit>
#include <new>
#include <utility>

// Vectors of a length unknown at compile time cannot be members of structs.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
// Highway compiles the rest of this file once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "telemime/likelihood/simd/kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "telemime/likelihood/simd/contour-inl.h"
#include "telemime/likelihood/simd/count-inl.h"
#include "telemime/likelihood/simd/still-inl.h"
#include "telemime/likelihood/simd/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace telemime::simd::HWY_NAMESPACE {

// The stages of one pose, up to the last one that is asked for.
inline void count_stages(const Batch& batch, const Placement& pose, Reductions& r, Workspace& ws) {
  const bool contour = wants(batch.terms, Reduction::contour);
  const SimdStage last = batch.last_stage;
  if (last == SimdStage::count) {
    keep_still(batch, pose, ws);
  }
  Memory& memory = ws.memory;
  const auto moves = [&memory](std::size_t s) { return (memory.still >> s & 1U) == 0; };
  // Project all segments first: a vector load that overlaps a recent store at another address would have to
  // wait.
  for (std::size_t s = 0; s < kSegmentCount && last >= SimdStage::project; ++s) {
    if (moves(s)) {
      memory.projection[s] = project_segment(batch, batch.model.segments[s], pose[s], ws);
    }
  }
  if (contour) {
    sample_still(batch, ws);
  }
  // Set up, draw and sample each segment that moves.
  ws.samples = memory.samples;
  for (std::size_t s = 0; s < kSegmentCount && last >= SimdStage::set_up; ++s) {
    const PackedSegment& segment = batch.model.segments[s];
    if (moves(s)) {
      const Facing facing = set_up_quads(batch, segment, memory.projection[s], ws);
      if (last >= SimdStage::draw) {
        draw_quads(batch, segment, facing, ws);
      }
      if (contour && last >= SimdStage::sample) {
        sample_contour(segment, facing, ws);
      }
    }
  }
  // Count contour and overlap, and clear the z-buffer.
  if (contour && last >= SimdStage::look_up) {
    sum_contour(batch.frame, ws, r);
  }
  if (last < SimdStage::count) {
    return;
  }
  if (wants(batch.terms, Reduction::overlap)) {
    memory.still != 0 ? count_and_clear<true, true>(batch.frame, ws, r)
                      : count_and_clear<true, false>(batch.frame, ws, r);
  } else {
    memory.still != 0 ? count_and_clear<false, true>(batch.frame, ws, r)
                      : count_and_clear<false, false>(batch.frame, ws, r);
  }
}

void count_pose(const Batch& batch, const Placement& pose, Reductions& out, Workspace& ws) {
  ws.fit(batch.frame.grid);
  // An exception (no memory for contour points) leaves the z-buffer uncleared: `pixels` = 0 makes fit() clear
  // it.
  const std::size_t pixels = std::exchange(ws.pixels, 0);
  count_stages(batch, pose, out, ws);
  ws.pixels = pixels;
}

}  // namespace telemime::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace telemime::simd {
namespace {

template <typename T>
hwy::AlignedFreeUniquePtr<T[]> allocated(std::size_t size) {
  auto array = hwy::AllocateAligned<T>(size);
  if (!array) {
    throw std::bad_alloc();
  }
  return array;
}

}  // namespace

void Workspace::fit(const TileGrid& grid) {
  if (pixels == grid.pixels() && grid_columns == grid.columns) {
    return;
  }
  pixels = 0;
  grid_columns = grid.columns;
  memory = {};
  depth = allocated<std::uint32_t>(grid.pixels() + 1);
  still_depth = allocated<std::uint32_t>(grid.pixels());
  pixels = grid.pixels();
  std::fill_n(depth.get(), pixels, 0);
  std::fill_n(still_depth.get(), pixels, 0);
  depth[pixels] = std::bit_cast<std::uint32_t>(1e30F);
}

void Workspace::grow_samples(std::size_t at_least) {
  const std::size_t larger = std::max<std::size_t>({at_least, 2 * capacity, 4096});
  const auto grow = [&]<typename T>(hwy::AlignedFreeUniquePtr<T[]>& array) {
    auto grown = allocated<T>(larger);
    std::copy_n(array.get(), capacity, grown.get());
    array = std::move(grown);
  };
  for (auto* array : {&sample_x, &sample_y, &sample_w, &sample_nearest}) {
    grow(*array);
  }
  for (auto* array : {&sample_pixel, &sample_distance}) {
    grow(*array);
  }
  capacity = larger;
}

std::vector<InstructionSet> instruction_sets() {
  const std::int64_t supported = hwy::SupportedTargets();
  std::vector<InstructionSet> sets;
  const auto offer = [&](std::int64_t target, std::string_view name, Kernel kernel) {
    if ((supported & target) != 0) {
      sets.push_back({name, kernel});
    }
  };
#if (HWY_TARGETS & HWY_AVX3_DL) != 0
  offer(HWY_AVX3_DL, "avx512", &N_AVX3_DL::count_pose);
#endif
#if (HWY_TARGETS & HWY_AVX3) != 0
  offer(HWY_AVX3, "avx512", &N_AVX3::count_pose);
#endif
#if (HWY_TARGETS & HWY_AVX2) != 0
  offer(HWY_AVX2, "avx2", &N_AVX2::count_pose);
#endif
#if (HWY_TARGETS & HWY_SSE4) != 0
  offer(HWY_SSE4, "sse4", &N_SSE4::count_pose);
#endif
#if (HWY_TARGETS & HWY_SSSE3) != 0
  offer(HWY_SSSE3, "ssse3", &N_SSSE3::count_pose);
#endif
#if (HWY_TARGETS & HWY_NEON) != 0
  offer(HWY_NEON, "neon", &N_NEON::count_pose);
#endif
#if (HWY_TARGETS & HWY_EMU128) != 0
  sets.push_back({"portable", &N_EMU128::count_pose});
#endif
#if (HWY_TARGETS & HWY_SCALAR) != 0
  sets.push_back({"portable", &N_SCALAR::count_pose});
#endif
  if (sets.empty()) {  // the instruction set that the compiler assumes
    sets.push_back({"baseline", &HWY_STATIC_DISPATCH(count_pose)});
  }
  return sets;
}

}  // namespace telemime::simd
#endif
