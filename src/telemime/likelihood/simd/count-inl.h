// SPDX-License-Identifier: Apache-2.0
// Counts the overlap of the drawn surface with the labels and clears the z-buffer for the next pose.
#if defined(TELEMIME_SIMD_COUNT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TELEMIME_SIMD_COUNT_INL_H
#undef TELEMIME_SIMD_COUNT_INL_H
#else
#define TELEMIME_SIMD_COUNT_INL_H
#endif

#include "telemime/likelihood/simd/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace telemime::simd::HWY_NAMESPACE {

// Each lane counts four classes in its four bytes.
struct ByteCounts {
  IntVector model, both;
};

HWY_INLINE ByteCounts no_counts() {
  return {hn::Zero(kInt), hn::Zero(kInt)};
}

HWY_INLINE std::int32_t sum_of_bytes(IntVector counts, int byte) {
  const IntVector one = hn::And(hn::ShiftRightSame(counts, byte * 8), hn::Set(kInt, 0xFF));
  return hn::GetLane(hn::SumOfLanes(kInt, one));
}

HWY_INLINE void flush(const ByteCounts& counts, Reductions& r) {
  for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
    r.model[c] += sum_of_bytes(counts.model, static_cast<int>(c) + 1);
    r.both[c] += sum_of_bytes(counts.both, static_cast<int>(c) + 1);
  }
}

HWY_INLINE void count_pixels(IntVector drawn, IntVector label, ByteCounts& counts) {
  const IntVector surface = hn::And(drawn, hn::Set(kInt, 0x18));
  const IntVector one = hn::Shl(hn::Set(kInt, 1), surface);
  counts.both = counts.both + hn::IfThenElseZero(label == surface, one);
  counts.model = counts.model + hn::IfThenElseZero(label < hn::Set(kInt, TiledPlanes::kUnknown), one);
}

// The vectors of all tiles in a rectangle: piece(index of the first pixel), after row(number of tiles) for
// each piece of a row of at most `most` tiles.
template <typename Row, typename Piece>
HWY_INLINE void each_vector(const TileRect& rect, int tile_columns, int most, const Row& row,
                            const Piece& piece) {
  for (int y = rect.top; y <= rect.bottom; ++y) {
    for (int left = rect.left; left <= rect.right; left += most) {
      const int columns = std::min(rect.right + 1 - left, most);
      row(columns);
      std::size_t at = static_cast<std::size_t>(y * tile_columns + left) * kTile;
      const std::size_t end = at + static_cast<std::size_t>(columns) * kTile;
      for (; at < end; at += kN) {
        piece(at);
      }
    }
  }
}

// Counts (if `counted`) and clears the tiles that each moving segment touched; a tile that two segments
// touched is already clear the second time. If some segments stay (`still`), tiles go back to these, and what
// they count there is taken away.
template <bool counted, bool still>
void count_and_clear(const TiledPlanes& frame, Workspace& ws, Reductions& r) {
  constexpr int kMostTiles = 255 / static_cast<int>(kParts);  // so that no byte overflows
  const hn::Rebind<std::uint8_t, Int> bytes;
  ByteCounts counts = no_counts();
  ByteCounts hidden = no_counts();
  Reductions less;
  int tiles = 0;
  const auto flush_all = [&] {
    flush(counts, r);
    counts = no_counts();
    if constexpr (still) {
      flush(hidden, less);
      hidden = no_counts();
    }
  };
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    const TileRect& rect = ws.memory.projection[s].tiles;
    if ((still && (ws.memory.still >> s & 1U) != 0) || rect.right < rect.left) {
      continue;
    }
    each_vector(
        rect, frame.grid.columns, kMostTiles,
        [&](int columns) {
          tiles += columns;
          if (counted && tiles > kMostTiles) {
            flush_all();
            tiles = columns;
          }
        },
        [&](std::size_t at) {
          auto* depth = reinterpret_cast<std::int32_t*>(ws.depth.get() + at);
          IntVector rest = hn::Zero(kInt);
          if constexpr (still) {
            rest = hn::Load(kInt, reinterpret_cast<const std::int32_t*>(ws.still_depth.get() + at));
          }
          if constexpr (counted) {
            const IntVector label = hn::PromoteTo(kInt, hn::LoadU(bytes, frame.labels.data() + at));
            count_pixels(hn::Load(kInt, depth), label, counts);
            if constexpr (still) {
              count_pixels(rest, label, hidden);
            }
          }
          hn::Store(rest, kInt, depth);
        });
  }
  if constexpr (counted) {
    flush_all();
    if constexpr (still) {
      for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
        r.model[c] += ws.memory.counts.model[c] - less.model[c];
        r.both[c] += ws.memory.counts.both[c] - less.both[c];
      }
    }
  }
}

}  // namespace telemime::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TELEMIME_SIMD_COUNT_INL_H
