// SPDX-License-Identifier: Apache-2.0
// Segments that stay where the pose before had them. A search moves one arm at a time: trunk, head and the
// other arm are drawn and counted once. What is counted is the same, bit for bit.
#if defined(TELEMIME_SIMD_STILL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TELEMIME_SIMD_STILL_INL_H
#undef TELEMIME_SIMD_STILL_INL_H
#else
#define TELEMIME_SIMD_STILL_INL_H
#endif

#include <bit>
#include <cstring>

#include "telemime/likelihood/simd/contour-inl.h"
#include "telemime/likelihood/simd/count-inl.h"

HWY_BEFORE_NAMESPACE();
namespace telemime::simd::HWY_NAMESPACE {

template <typename... Segments>
constexpr SegmentSet set_of(Segments... segments) {
  return ((SegmentSet{1} << static_cast<unsigned>(segments)) | ...);
}
constexpr SegmentSet kTrunk = set_of(Segment::chest, Segment::head);
constexpr SegmentSet kArms[] = {set_of(Segment::l_upper_arm, Segment::l_forearm, Segment::l_hand),
                                set_of(Segment::r_upper_arm, Segment::r_forearm, Segment::r_hand)};

// The segments in the same place as those of the pose before. Remembers this pose.
inline SegmentSet unmoved(const Placement& pose, Memory& memory) {
  SegmentSet same = 0;
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    same |= SegmentSet{std::memcmp(&pose[s], &memory.placed[s], sizeof pose[s]) == 0} << s;
  }
  memory.placed = pose;
  return same;
}

// Forgets the segments that stayed.
inline void clear_still(const TileGrid& grid, Workspace& ws) {
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    if ((ws.memory.still >> s & 1U) != 0) {
      each_vector(
          ws.memory.projection[s].tiles, grid.columns, grid.columns, [](int) {},
          [&ws](std::size_t at) {
            for (std::uint32_t* plane : {ws.depth.get(), ws.still_depth.get()}) {
              hn::Store(hn::Zero(kInt), kInt, reinterpret_cast<std::int32_t*>(plane + at));
            }
          });
    }
  }
  ws.memory.still = 0;
  ws.memory.sampled = 0;
  ws.memory.samples = 0;
}

// Draws and counts these segments, whose vertices are those of the pose before.
inline void draw_still(const Batch& batch, SegmentSet segments, Workspace& ws) {
  Memory& memory = ws.memory;
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    if ((segments >> s & 1U) != 0) {
      memory.facing[s] = set_up_quads(batch, batch.model.segments[s], memory.projection[s], ws);
      draw_quads(batch, batch.model.segments[s], memory.facing[s], ws);
    }
  }
  // A pixel counts when its tile is reached for the first time, and is in both planes then.
  const hn::Rebind<std::uint8_t, Int> bytes;
  constexpr int kMostTiles = 255 / static_cast<int>(kParts);
  memory.counts = {};
  ByteCounts counts = no_counts();
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    if ((segments >> s & 1U) == 0) {
      continue;
    }
    each_vector(
        memory.projection[s].tiles, batch.frame.grid.columns, kMostTiles,
        [&](int) {
          flush(counts, memory.counts);
          counts = no_counts();
        },
        [&](std::size_t at) {
          auto* kept = reinterpret_cast<std::int32_t*>(ws.still_depth.get() + at);
          const IntVector drawn = hn::Load(kInt, reinterpret_cast<const std::int32_t*>(ws.depth.get() + at));
          const IntVector fresh = hn::IfThenZeroElse(hn::Load(kInt, kept) == drawn, drawn);
          const IntVector label = hn::PromoteTo(kInt, hn::LoadU(bytes, batch.frame.labels.data() + at));
          count_pixels(fresh, label, counts);
          hn::Store(drawn, kInt, kept);
        });
  }
  flush(counts, memory.counts);
  memory.still = segments;
}

// Samples the contour of the segments that stay, once. What moves can only hide more of it, so points that
// are hidden already are dropped.
inline void sample_still(const Batch& batch, Workspace& ws) {
  Memory& memory = ws.memory;
  if (memory.sampled == memory.still) {
    return;
  }
  ws.samples = 0;
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    if ((memory.still >> s & 1U) != 0) {
      sample_contour(batch.model.segments[s], memory.facing[s], ws);
    }
  }
  find_pixels(batch.frame.grid, 0, ws);
  const FloatVector thickness = number(kThickness);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < ws.samples; ++i) {
    const std::int32_t pixel = ws.sample_pixel[i];
    const auto at = static_cast<std::size_t>(pixel);
    const FloatVector nearest = number(std::bit_cast<float>(ws.depth[at]));
    if (hn::AllFalse(kFloat, is_hidden(nearest, number(ws.sample_w[i]), thickness))) {
      ws.sample_w[kept] = ws.sample_w[i];
      ws.sample_pixel[kept] = pixel;
      ws.sample_distance[kept] = batch.frame.distance[at];
      ++kept;
    }
  }
  // Points outside the image, which are hidden, fill the last vector.
  for (; kept % kTile != 0; ++kept) {
    ws.sample_w[kept] = 1.0F;
    ws.sample_pixel[kept] = static_cast<std::int32_t>(batch.frame.grid.pixels());
    ws.sample_distance[kept] = 0;
  }
  memory.samples = kept;
  memory.sampled = memory.still;
}

// Decides which segments of a pose stay, and has these in both planes of depths.
inline void keep_still(const Batch& batch, const Placement& pose, Workspace& ws) {
  Memory& memory = ws.memory;
  const bool known = memory.model == batch.model.content && memory.frame == batch.frame.content &&
                     memory.camera == batch.camera && memory.model && memory.frame;
  const SegmentSet same = unmoved(pose, memory);
  if (known && (memory.still & ~same) == 0 && memory.still != 0) {
    return;
  }
  clear_still(batch.frame.grid, ws);
  if (!known) {
    memory.model = batch.model.content;
    memory.frame = batch.frame.content;
    memory.camera = batch.camera;
    return;
  }
  if ((kTrunk & ~same) == 0) {
    SegmentSet segments = kTrunk;
    for (const SegmentSet arm : kArms) {
      segments |= (arm & ~same) == 0 ? arm : 0;
    }
    draw_still(batch, segments, ws);
  }
}

}  // namespace telemime::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TELEMIME_SIMD_STILL_INL_H
