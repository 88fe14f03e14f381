// SPDX-License-Identifier: Apache-2.0
// Segments that stay where the pose before had them. A search moves one arm at a time: trunk, head and the
// other arm are drawn and counted once. What is counted is the same, bit for bit.
#if defined(TELEMIME_SIMD_STILL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TELEMIME_SIMD_STILL_INL_H
#undef TELEMIME_SIMD_STILL_INL_H
#else
#define TELEMIME_SIMD_STILL_INL_H
#endif

#include <algorithm>
#include <cstring>

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
inline SegmentSet unmoved(std::size_t lane, Workspace& ws) {
  SegmentSet same = 0;
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    float placed[12];
    for (std::size_t k = 0; k < 12; ++k) {
      placed[k] = ws.transform[12 * s + k][lane];
    }
    same |= SegmentSet{std::memcmp(placed, ws.memory.placed[s], sizeof placed) == 0} << s;
    std::memcpy(ws.memory.placed[s], placed, sizeof placed);
  }
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

// Decides which segments of a pose stay, and has these in both planes of depths.
inline void keep_still(const Batch& batch, std::size_t lane, Workspace& ws) {
  Memory& memory = ws.memory;
  const bool known = memory.model == batch.model.content && memory.frame == batch.frame.content &&
                     memory.camera == batch.camera && memory.model && memory.frame;
  const SegmentSet same = unmoved(lane, ws);
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
