// SPDX-License-Identifier: Apache-2.0
// From a segment's transform to its pixels: projects vertices, computes lines and planes of quadrilaterals,
// and does the z-buffer test tile by tile. Lanes are vertices, then quadrilaterals, then pixels.
#if defined(TELEMIME_SIMD_SURFACE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TELEMIME_SIMD_SURFACE_INL_H
#undef TELEMIME_SIMD_SURFACE_INL_H
#else
#define TELEMIME_SIMD_SURFACE_INL_H
#endif

#include <algorithm>
#include <bit>
#include <limits>

#include "telemime/likelihood/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace telemime::simd::HWY_NAMESPACE {

HWY_INLINE float smallest_of(FloatVector v) {
  return hn::GetLane(hn::MinOfLanes(kFloat, v));
}
HWY_INLINE float largest_of(FloatVector v) {
  return hn::GetLane(hn::MaxOfLanes(kFloat, v));
}

// Tiles of the pixels in [low, high] (in tiles) of an image of `size` pixels; none: last < first.
HWY_INLINE void tile_interval(float low, float high, int size, std::int32_t& first, std::int32_t& last) {
  const float end = static_cast<float>(size - 1) * 0.25F;
  first = low > 0.0F ? static_cast<std::int32_t>(std::min(low, end)) : 0;
  last = first - 1;
  if (high >= 0.0F && low <= end) {
    last = std::max(static_cast<std::int32_t>(std::min(high, end)), first + 2);
  }
}

inline Projection project_segment(const Batch& batch, const PackedSegment& segment,
                                  const std::array<float, 12>& camera_from_segment, Workspace& ws) {
  constexpr float kNearest = 0.05F;
  constexpr float kFar = 1e30F;
  FloatVector transform[12];
  for (std::size_t k = 0; k < 12; ++k) {
    transform[k] = number(camera_from_segment[k]);
  }
  const float scale = 1.0F / static_cast<float>(TileGrid::kSide);
  const FloatVector fx = number(batch.camera.fx * scale);
  const FloatVector fy = number(batch.camera.fy * scale);
  const FloatVector cx = number(batch.camera.cx * scale);
  const FloatVector cy = number(batch.camera.cy * scale);
  FloatVector left = number(kFar);
  FloatVector top = left;
  FloatVector right = number(-kFar);
  FloatVector bottom = right;
  FloatVector farthest = left;
  // Vertices after the last one are at the segment's origin. One that is not a number counts nowhere.
  const std::uint32_t end = segment.begin + segment.lanes + segment.stride;
  for (std::uint32_t at = segment.begin; at < end; at += kN) {
    FloatVector u;
    FloatVector v;
    FloatVector w;
    project_vertex(transform, hn::LoadU(kFloat, &batch.model.x[at]), hn::LoadU(kFloat, &batch.model.y[at]),
                   hn::LoadU(kFloat, &batch.model.z[at]), fx, fy, cx, cy, number(kNearest), &u, &v, &w);
    hn::Store(u, kFloat, ws.u + at);
    hn::Store(v, kFloat, ws.v + at);
    hn::Store(w, kFloat, ws.w + at);
    left = hn::IfThenElse(u < left, u, left);
    right = hn::IfThenElse(u > right, u, right);
    top = hn::IfThenElse(v < top, v, top);
    bottom = hn::IfThenElse(v > bottom, v, bottom);
    farthest = hn::IfThenElse(w < farthest, w, farthest);
  }
  Projection projection;
  const TileGrid& grid = batch.frame.grid;
  TileRect& tiles = projection.tiles;
  tile_interval(smallest_of(left), largest_of(right), grid.width, tiles.left, tiles.right);
  tile_interval(smallest_of(top), largest_of(bottom), grid.height, tiles.top, tiles.bottom);
  projection.behind = smallest_of(farthest) <= 0.0F;
  return projection;
}

HWY_INLINE Corner corner_at(const Workspace& ws, std::size_t i) {
  return {hn::LoadU(kFloat, ws.u + i), hn::LoadU(kFloat, ws.v + i), hn::LoadU(kFloat, ws.w + i)};
}

HWY_INLINE FloatVector smallest(FloatVector a, FloatVector b, FloatVector c, FloatVector d) {
  return hn::Min(hn::Min(a, b), hn::Min(c, d));
}
HWY_INLINE FloatVector largest(FloatVector a, FloatVector b, FloatVector c, FloatVector d) {
  return hn::Max(hn::Max(a, b), hn::Max(c, d));
}

// First and last tile of the pixel centres in [low, high] (in tiles), within an image that ends at `end`.
struct TileRange {
  IntVector first, last;
  FloatMask any;
};
HWY_INLINE TileRange tile_range(FloatVector low, FloatVector high, FloatVector end) {
  const FloatVector side = number(static_cast<float>(TileGrid::kSide));
  const FloatVector quarter = number(0.25F);
  const FloatVector first = hn::Ceil(hn::Max(low, hn::Zero(kFloat)) * side) * quarter;
  const FloatVector last = hn::Floor(hn::Min(high, end) * side) * quarter;
  return {hn::ConvertTo(kInt, first), hn::ConvertTo(kInt, last), first <= last};
}

HWY_INLINE void store_line(const Linear& line, std::size_t k, std::size_t i, Workspace& ws) {
  hn::Store(line.a, kFloat, ws.line[3 * k] + i);
  hn::Store(line.b, kFloat, ws.line[3 * k + 1] + i);
  hn::Store(line.c, kFloat, ws.line[3 * k + 2] + i);
}

// Lines, planes and tiles of a segment's quadrilaterals, for draw_quads().
inline Facing set_up_quads(const Batch& batch, const PackedSegment& segment, const Projection& projection,
                           Workspace& ws) {
  Facing facing;
  // m, depth up to which a quadrilateral counts as flat.
  constexpr float kFlat = 1e-3F;
  const FloatVector zero = hn::Zero(kFloat);
  const IntVector two = hn::Set(kInt, 2);
  const IntVector top_mark = hn::Set(kInt, PackedModel::kTop);
  const IntVector bottom_mark = hn::Set(kInt, PackedModel::kBottom);
  const IntVector tile_columns = hn::Set(kInt, batch.frame.grid.columns);
  const FloatVector image_right = number(static_cast<float>(batch.frame.grid.width - 1) * 0.25F);
  const FloatVector image_bottom = number(static_cast<float>(batch.frame.grid.height - 1) * 0.25F);
  // Last tiles at which a block of 2 x 2 or 3 x 3 tiles may begin.
  const IntVector last_x[2] = {hn::Set(kInt, projection.tiles.right - 1),
                               hn::Set(kInt, projection.tiles.right - 2)};
  const IntVector last_y[2] = {hn::Set(kInt, projection.tiles.bottom - 1),
                               hn::Set(kInt, projection.tiles.bottom - 2)};
  const auto* marks = reinterpret_cast<const std::int32_t*>(batch.model.surface.data()) + segment.begin;
  if (!projection.behind) {
    facing.known[0] = facing.known[1] = segment.quads;
  }
  for (std::uint32_t i = 0; i < segment.lanes; i += kN) {
    const std::uint32_t at = segment.begin + i;
    const Corner a = corner_at(ws, at);
    const Corner b = corner_at(ws, at + segment.stride);
    const Corner c = corner_at(ws, at + 1);
    const Corner d = corner_at(ws, at + segment.stride + 1);
    const std::size_t word = i / 64;
    const std::uint32_t shift = i % 64;
    // Which of the two triangles face the camera, and which are in front of it.
    const FloatVector area1 = doubled_area(&a, &b, &c);
    const FloatVector area2 = doubled_area(&b, &d, &c);
    FloatMask front1 = area1 < zero;
    FloatMask front2 = area2 < zero;
    if (projection.behind) {
      const FloatMask inner = hn::And(b.w != zero, c.w != zero);
      const FloatMask known1 = hn::And(inner, a.w != zero);
      const FloatMask known2 = hn::And(inner, d.w != zero);
      front1 = hn::And(front1, known1);
      front2 = hn::And(front2, known2);
      facing.known[0][word] |= bits_of(known1) << shift;
      facing.known[1][word] |= bits_of(known2) << shift;
    }
    if (hn::AllFalse(kFloat, hn::Or(front1, front2))) {
      continue;
    }
    facing.front[0][word] |= bits_of(front1) << shift;
    facing.front[1][word] |= bits_of(front2) << shift;
    // The depth plane is that of the larger triangle that faces the camera.
    const FloatMask from_first = hn::And(front1, hn::Or(hn::Not(front2), area1 <= area2));
    // One division for both areas; that of the other triangle matters only where it is visible.
    const FloatMask both = hn::And(front1, front2);
    const FloatVector own_area = hn::IfThenElse(from_first, area1, area2);
    const FloatVector other_area =
        hn::IfThenElse(both, hn::IfThenElse(from_first, area2, area1), number(-1.0F));
    const FloatVector inverse = number(1.0F) / (own_area * other_area);
    const Linear plane = depth_plane(&a, &b, &c, &d, from_first, other_area * inverse);
    store_line(plane, 4, i, ws);
    // Fold: where the other triangle is not in that plane, 1/z bends at the diagonal.
    const Corner left_out = select_corner(from_first, d, a);
    const FloatVector gap = depth_gap(&plane, &left_out);
    const FloatVector bound = number(kFlat) * left_out.w * left_out.w;
    const FloatMask folded = hn::And(both, hn::Abs(gap) > bound);
    const Linear fold = fold_line(&b, &c, from_first);
    store_line(fold, 5, i, ws);
    hn::Store(gap * own_area * inverse, kFloat, ws.bend + i);
    facing.folded[word] |= bits_of(folded) << shift;
    // At the ends one of the two triangles has zero area.
    const IntVector mark = hn::LoadU(kInt, marks + i);
    const FloatMask at_top = hn::RebindMask(kFloat, hn::TestBit(mark, top_mark));
    const FloatMask at_bottom = hn::RebindMask(kFloat, hn::TestBit(mark, bottom_mark));
    const FloatMask whole1 = hn::Or(front1, hn::And(at_top, front2));
    front2 = hn::Or(front2, hn::And(at_bottom, front1));
    front1 = whole1;

    // Bounding box and edges of the visible part.
    const Corner p = select_corner(front1, a, b);
    const Corner q = select_corner(front2, d, c);
    const FloatVector low_u = smallest(p.u, q.u, b.u, c.u);
    const FloatVector low_v = smallest(p.v, q.v, b.v, c.v);
    const FloatVector high_u = largest(p.u, q.u, b.u, c.u);
    const FloatVector high_v = largest(p.v, q.v, b.v, c.v);
    Linear edge[4];
    quad_lines(&p, &b, &c, &q, quad_margin(high_u - low_u, high_v - low_v), edge);
    for (std::size_t k = 0; k < 4; ++k) {
      store_line(edge[k], k, i, ws);
    }
    // Tiles of the box; a small or medium block is moved so that it ends inside the segment's tiles.
    const TileRange x = tile_range(low_u, high_u, image_right);
    const TileRange y = tile_range(low_v, high_v, image_bottom);
    const FloatMask drawn = hn::And(hn::Or(front1, front2), hn::And(x.any, y.any));
    const IntVector columns = x.last - x.first;
    const IntVector rows = y.last - y.first;
    const IntVector longer = hn::Max(columns, rows);
    const auto small = longer < two;
    const auto medium = longer < hn::Set(kInt, 3);
    const auto block = [&](IntVector first, const IntVector* last) {
      const IntVector moved = hn::Min(first, hn::IfThenElse(small, last[0], last[1]));
      return hn::IfThenElse(medium, moved, first);
    };
    const auto narrow = columns < hn::Set(kInt, 1);
    const IntVector tile_x = hn::IfThenElse(hn::And(narrow, small), x.first, block(x.first, last_x));
    const IntVector tile_y = block(y.first, last_y);
    hn::Store(tile_y * tile_columns + tile_x, kInt, ws.tile + i);
    hn::Store(hn::ConvertTo(kFloat, tile_x), kFloat, ws.tile_x + i);
    hn::Store(hn::ConvertTo(kFloat, tile_y), kFloat, ws.tile_y + i);
    hn::Store(columns, kInt, ws.columns + i);
    hn::Store(rows, kInt, ws.rows + i);
    facing.drawn[word] |= bits_of(drawn) << shift;
    facing.small[word] |= bits_of(hn::RebindMask(kFloat, small)) << shift;
    facing.narrow[word] |= bits_of(hn::RebindMask(kFloat, narrow)) << shift;
    facing.medium[word] |= bits_of(hn::RebindMask(kFloat, medium)) << shift;
  }
  // Make the sets disjoint and drop lanes without a quadrilateral.
  for (std::size_t word = 0; word < facing.drawn.size(); ++word) {
    facing.drawn[word] &= segment.quads[word];
    facing.folded[word] &= facing.drawn[word];
    facing.small[word] &= facing.drawn[word];
    facing.narrow[word] &= facing.small[word];
    facing.medium[word] &= facing.drawn[word] & ~facing.small[word];
  }
  return facing;
}

// Linear functions of one quadrilateral at kN pixels: four edges, the depth plane, and the fold if it has
// one.
template <std::size_t size>
struct Pixels {
  FloatVector at[size];
};

template <std::size_t size>
HWY_INLINE Pixels<size> operator+(const Pixels<size>& p, const FloatVector* step) {
  Pixels<size> sum;
  for (std::size_t k = 0; k < size; ++k) {
    sum.at[k] = p.at[k] + step[k];
  }
  return sum;
}

// The z-buffer test: positive floats order like their bits as integers; a pixel outside an edge has its sign
// bit set and is therefore smaller than all others.
template <std::size_t size>
HWY_INLINE void test_pixels(const Pixels<size>& p, FloatVector bend, IntVector surface,
                            std::uint32_t* depth) {
  const IntVector keep = hn::Set(kInt, ~0x1F);
  const IntVector sign = hn::Set(kInt, std::numeric_limits<std::int32_t>::min());
  FloatVector w = p.at[4];
  if constexpr (size > 5) {
    w = hn::MulAdd(bend, hn::Min(p.at[5], hn::Zero(kFloat)), w);
  }
  const IntVector outside =
      hn::Or3(hn::BitCast(kInt, p.at[0]), hn::BitCast(kInt, p.at[1]), hn::BitCast(kInt, p.at[2]));
  IntVector value = hn::OrAnd(surface, hn::BitCast(kInt, w), keep);
  value = hn::OrAnd(value, hn::Or(outside, hn::BitCast(kInt, p.at[3])), sign);
  auto* pixels = reinterpret_cast<std::int32_t*>(depth);
  hn::Store(hn::Max(value, hn::Load(kInt, pixels)), kInt, pixels);
}

// Draws a quadrilateral of 5 linear functions, or of 6 if it is folded.
template <std::size_t size>
HWY_INLINE void draw_quad(std::size_t i, std::uint32_t surface, int tile_columns, int columns, int rows,
                          Workspace& ws) {
  FloatVector across[size];
  FloatVector down[size];
  Pixels<size> base[kParts];
  const FloatVector lane = hn::Iota(kFloat, 0.0F);
  const FloatVector in_row = hn::ConvertTo(kFloat, hn::Iota(kInt, 0) & hn::Set(kInt, 3));
  const FloatVector quarter = number(0.25F);
  const FloatVector x = in_row * quarter + number(ws.tile_x[i]);
  // Rows of a vector's lanes, in tiles.
  const FloatVector row = (lane - in_row) * number(0.0625F) + number(ws.tile_y[i]);
  for (std::size_t k = 0; k < size; ++k) {
    across[k] = number(ws.line[3 * k][i]);
    down[k] = number(ws.line[3 * k + 1][i]);
    const FloatVector along = hn::MulAdd(across[k], x, number(ws.line[3 * k + 2][i]));
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t rows_above = part * kN / 4;
      const FloatVector below = row + number(static_cast<float>(rows_above) * 0.25F);
      base[part].at[k] = hn::MulAdd(down[k], below, along);
      if constexpr (kN < 4) {  // a vector is shorter than a tile's row
        base[part].at[k] = base[part].at[k] + across[k] * number(static_cast<float>(part * kN % 4) * 0.25F);
      }
    }
  }
  const FloatVector bend = size > 5 ? number(ws.bend[i]) : hn::Zero(kFloat);
  const IntVector code = hn::Set(kInt, static_cast<std::int32_t>(surface));
  for (std::size_t part = 0; part < kParts; ++part) {
    std::uint32_t* first = ws.depth.get() + static_cast<std::size_t>(ws.tile[i]) * kTile + part * kN;
    Pixels<size> start = base[part];
    for (int r = 0; r <= rows; ++r) {
      Pixels<size> here = start;
      std::uint32_t* depth = first;
      for (int c = 0; c <= columns; ++c) {
        test_pixels(here, bend, code, depth);
        here = here + across;
        depth += kTile;
      }
      start = start + down;
      first += static_cast<std::ptrdiff_t>(tile_columns) * TileGrid::kPixels;
    }
  }
}

template <std::size_t size, typename Tiles>
HWY_INLINE void draw_some(std::uint64_t lanes, std::size_t first, const std::uint32_t* surface,
                          int tile_columns, Workspace& ws, const Tiles& tiles) {
  for (; lanes != 0; lanes &= lanes - 1) {
    const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(lanes));
    const auto [columns, rows] = tiles(i);
    draw_quad<size>(i, surface[i] & 0x1FU, tile_columns, columns, rows, ws);
  }
}

// Most quadrilaterals of a small image touch few tiles: 1 x 2, 2 x 2 or 3 x 3 are always tested in full,
// since loops of unpredictable length would cost more.
inline void draw_quads(const Batch& batch, const PackedSegment& segment, const Facing& facing,
                       Workspace& ws) {
  struct Size {
    int columns, rows;  ///< minus one
  };
  const int tile_columns = batch.frame.grid.columns;
  const std::uint32_t* surface = batch.model.surface.data() + segment.begin;
  const auto own = [&ws](std::size_t i) { return Size{ws.columns[i], ws.rows[i]}; };
  for (std::size_t word = 0; word < facing.drawn.size(); ++word) {
    const std::size_t first = 64 * word;
    const std::uint64_t narrow = facing.narrow[word];
    const std::uint64_t small = facing.small[word];
    const std::uint64_t medium = facing.medium[word];
    const std::uint64_t folded = facing.folded[word];
    const std::uint64_t large = facing.drawn[word] & ~small & ~medium;
    const auto one_by_two = [](std::size_t) { return Size{0, 1}; };
    const auto two_by_two = [](std::size_t) { return Size{1, 1}; };
    const auto three_by_three = [](std::size_t) { return Size{2, 2}; };
    draw_some<5>(narrow & ~folded, first, surface, tile_columns, ws, one_by_two);
    draw_some<5>(small & ~narrow & ~folded, first, surface, tile_columns, ws, two_by_two);
    draw_some<5>(medium & ~folded, first, surface, tile_columns, ws, three_by_three);
    draw_some<5>(large & ~folded, first, surface, tile_columns, ws, own);
    draw_some<6>(narrow & folded, first, surface, tile_columns, ws, one_by_two);
    draw_some<6>(small & ~narrow & folded, first, surface, tile_columns, ws, two_by_two);
    draw_some<6>(medium & folded, first, surface, tile_columns, ws, three_by_three);
    draw_some<6>(large & folded, first, surface, tile_columns, ws, own);
  }
}

}  // namespace telemime::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TELEMIME_SIMD_SURFACE_INL_H
