// SPDX-License-Identifier: Apache-2.0
// The visible occluding contour: edges between a triangle that faces the camera and one that does not,
// sampled about once a pixel; the samples that nothing hides are looked up in the distance map.
#if defined(TELEMIME_SIMD_CONTOUR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TELEMIME_SIMD_CONTOUR_INL_H
#undef TELEMIME_SIMD_CONTOUR_INL_H
#else
#define TELEMIME_SIMD_CONTOUR_INL_H
#endif

#include <algorithm>
#include <limits>

#include "telemime/likelihood/simd/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace telemime::simd::HWY_NAMESPACE {

// Shifts of lane sets as long integers; by < 64.
inline LaneSet shifted_up(const LaneSet& set, std::uint32_t by) {
  LaneSet out{};
  for (std::size_t k = 0; k < set.size(); ++k) {
    out[k] = set[k] << by | (k > 0 ? set[k - 1] >> 1 >> (63 - by) : 0);
  }
  return out;
}
inline LaneSet shifted_down(const LaneSet& set, std::uint32_t by) {
  LaneSet out{};
  for (std::size_t k = 0; k < set.size(); ++k) {
    out[k] = set[k] >> by | (k + 1 < set.size() ? set[k + 1] << 1 << (63 - by) : 0);
  }
  return out;
}
// Repeats the lanes of the first side after those of the last one, where the surface closes.
inline LaneSet closed(LaneSet set, const PackedSegment& segment) {
  const std::uint64_t first = set[0] & ~(~std::uint64_t{0} << 1 << (segment.stride - 1));
  const std::size_t word = segment.lanes / 64;
  const std::uint32_t bit = segment.lanes % 64;
  set[word] |= first << bit;
  if (word + 1 < set.size()) {
    set[word + 1] |= first >> 1 >> (63 - bit);
  }
  return set;
}

// Samples one edge from vertex a to vertex b, in tiles. Most edges are a few pixels long, so short vectors
// suffice.
HWY_INLINE void sample_edge(std::size_t a, std::size_t b, Workspace& ws) {
  constexpr float kLongest = 4096.0F;
  const hn::CappedTag<float, 8> few;
  const auto x = hn::Set(few, ws.u[a]);
  const auto y = hn::Set(few, ws.v[a]);
  const auto w = hn::Set(few, ws.w[a]);
  const auto dx = hn::Set(few, ws.u[b]) - x;
  const auto dy = hn::Set(few, ws.v[b]) - y;
  const auto dw = hn::Set(few, ws.w[b]) - w;
  const hn::CappedTag<float, 1> one;
  const auto square = hn::Set(one, hn::GetLane(hn::MulAdd(dx, dx, dy * dy)));
  const float length = static_cast<float>(TileGrid::kSide) * hn::GetLane(hn::Sqrt(square));
  if (!(length < kLongest)) {
    return;
  }
  const std::int32_t steps = std::max(1, static_cast<std::int32_t>(length + 0.5F));
  std::size_t at = ws.samples;
  ws.samples = at + static_cast<std::size_t>(steps);
  constexpr std::size_t kFilled = 2 * TileGrid::kPixels;  // to the end of a tile's row, and one more
  if (ws.samples + kFilled > ws.capacity) {
    ws.grow_samples(ws.samples + kFilled);
  }
  float* const xs = ws.sample_x.get();
  float* const ys = ws.sample_y.get();
  float* const ws_of_points = ws.sample_w.get();
  const auto inverse = hn::Set(few, 1.0F / static_cast<float>(steps));
  auto place = hn::Iota(few, 0.5F);
  while (true) {
    const auto t = place * inverse;
    hn::StoreU(hn::MulAdd(dx, t, x), few, xs + at);
    hn::StoreU(hn::MulAdd(dy, t, y), few, ys + at);
    hn::StoreU(hn::MulAdd(dw, t, w), few, ws_of_points + at);
    at += hn::MaxLanes(few);
    if (at >= ws.samples) {
      return;
    }
    place = place + hn::Set(few, static_cast<float>(hn::MaxLanes(few)));
  }
}

template <typename Ends>
HWY_INLINE void sample_edges(const LaneSet& lanes, const Ends& ends, Workspace& ws) {
  for (std::size_t word = 0; word < lanes.size(); ++word) {
    for (std::uint64_t rest = lanes[word]; rest != 0; rest &= rest - 1) {
      ends(64 * word + static_cast<std::size_t>(std::countr_zero(rest)), ws);
    }
  }
}

inline void sample_contour(const PackedSegment& segment, const Facing& facing, Workspace& ws) {
  const std::uint32_t stride = segment.stride;
  // At the ends a quadrilateral has only one triangle.
  LaneSet front1{};
  LaneSet front2{};
  LaneSet known1{};
  LaneSet known2{};
  for (std::size_t k = 0; k < front1.size(); ++k) {
    const auto take = [&](const LaneSet& own, const LaneSet& other, const LaneSet& end) {
      return ((own[k] & ~end[k]) | (other[k] & end[k])) & segment.quads[k];
    };
    front1[k] = take(facing.front[0], facing.front[1], segment.top);
    front2[k] = take(facing.front[1], facing.front[0], segment.bottom);
    known1[k] = take(facing.known[0], facing.known[1], segment.top);
    known2[k] = take(facing.known[1], facing.known[0], segment.bottom);
  }
  // Edges between neighbouring triangles of which exactly one faces the camera: along the sides, along the
  // diagonals and along the rings.
  const LaneSet here_front = closed(front1, segment);
  const LaneSet here_known = closed(known1, segment);
  const LaneSet beside_front = shifted_up(front2, stride);
  const LaneSet beside_known = shifted_up(known2, stride);
  const LaneSet below_front = shifted_down(front1, 1);
  const LaneSet below_known = shifted_down(known1, 1);
  LaneSet along{};
  LaneSet diagonal{};
  LaneSet ring{};
  for (std::size_t k = 0; k < along.size(); ++k) {
    along[k] = (here_front[k] ^ beside_front[k]) & here_known[k] & beside_known[k];
    diagonal[k] = (front1[k] ^ front2[k]) & known1[k] & known2[k];
    ring[k] = (front2[k] ^ below_front[k]) & known2[k] & below_known[k];
  }
  // Sample these edges.
  const std::size_t at = segment.begin;
  sample_edges(
      along, [at](std::size_t i, Workspace& w) { sample_edge(at + i, at + i + 1, w); }, ws);
  sample_edges(
      diagonal, [at, stride](std::size_t i, Workspace& w) { sample_edge(at + i + stride, at + i + 1, w); },
      ws);
  sample_edges(
      ring, [at, stride](std::size_t i, Workspace& w) { sample_edge(at + i + 1, at + i + stride + 1, w); },
      ws);
}

// Pixel of each point from `first` on, a multiple of a tile's pixels; points outside the image get the
// additional last one.
inline void find_pixels(const TileGrid& grid, std::size_t first, Workspace& ws) {
  const FloatVector low = number(-0.5F);
  const FloatVector right = number(static_cast<float>(grid.width) - 0.5F);
  const FloatVector bottom = number(static_cast<float>(grid.height) - 0.5F);
  const FloatVector half = number(0.5F);
  const FloatVector side = number(static_cast<float>(TileGrid::kSide));
  const IntVector three = hn::Set(kInt, 3);
  const IntVector columns = hn::Set(kInt, grid.columns);
  const IntVector last_column = hn::Set(kInt, grid.width - 1);
  const IntVector last_row = hn::Set(kInt, grid.height - 1);
  const IntVector outside = hn::Set(kInt, static_cast<std::int32_t>(grid.pixels()));
  for (std::size_t i = first; i < ws.samples; i += kN) {
    const FloatVector x = hn::Load(kFloat, ws.sample_x.get() + i) * side;
    const FloatVector y = hn::Load(kFloat, ws.sample_y.get() + i) * side;
    const FloatMask inside = hn::And(hn::And(x > low, x < right), hn::And(y > low, y < bottom));
    const IntVector px = hn::Min(hn::ConvertTo(kInt, x + half), last_column);
    const IntVector py = hn::Min(hn::ConvertTo(kInt, y + half), last_row);
    const IntVector tile = hn::ShiftRight<2>(py) * columns + hn::ShiftRight<2>(px);
    const IntVector pixel = hn::ShiftLeft<4>(tile) + hn::ShiftLeft<2>(py & three) + (px & three);
    hn::Store(hn::IfThenElse(hn::RebindMask(kInt, inside), pixel, outside), kInt, ws.sample_pixel.get() + i);
  }
}

constexpr float kThickness = 0.015F;  // m: a point this far behind the surface of its pixel is hidden

// Distances under the visible points. Whole numbers: the order of the points does not matter. The first
// points, of segments that stay, have their pixels and distances already.
inline void sum_contour(const TiledPlanes& frame, Workspace& ws, Reductions& r) {
  // Points of a lane's sum: even the largest distances fit into 32 bits.
  constexpr std::size_t kMostPoints = 256;
  static_assert(1.0 * kMostPoints * TiledPlanes::kDistanceEnd < std::numeric_limits<std::int32_t>::max());
  if (ws.samples == 0) {
    return;
  }
  find_pixels(frame.grid, ws.memory.samples, ws);
  // Depth and distance at the pixel of each point; one by one, since vector gathers are slower.
  const auto* depth = reinterpret_cast<const float*>(ws.depth.get());
  const std::int32_t* map = frame.distance.data();
  const std::int32_t* pixel = ws.sample_pixel.get();
  float* nearest = ws.sample_nearest.get();
  std::int32_t* distance = ws.sample_distance.get();
  for (std::size_t i = 0; i < ws.memory.samples; ++i) {
    nearest[i] = depth[static_cast<std::size_t>(pixel[i])];
  }
  for (std::size_t i = ws.memory.samples; i < ws.samples; ++i) {
    const auto at = static_cast<std::size_t>(pixel[i]);
    nearest[i] = depth[at];
    distance[i] = map[at];
  }
  // Points after the last one are hidden by a very near pixel.
  for (std::size_t i = 0; i < kTile; i += kN) {
    hn::StoreU(number(1e30F), kFloat, ws.sample_nearest.get() + ws.samples + i);
    hn::StoreU(number(1.0F), kFloat, ws.sample_w.get() + ws.samples + i);
  }
  // Add the distances of visible points.
  std::int64_t all = 0;
  std::size_t points = 0;
  for (std::size_t first = 0; first < ws.samples; first += kMostPoints * kN) {
    const std::size_t end = std::min(first + kMostPoints * kN, ws.samples);
    IntVector sum = hn::Zero(kInt);
    for (std::size_t i = first; i < end; i += kN) {
      const FloatVector w = hn::Load(kFloat, ws.sample_w.get() + i);
      const FloatMask seen = hn::Not(is_hidden(hn::Load(kFloat, nearest + i), w, number(kThickness)));
      sum = sum + hn::IfThenElseZero(hn::RebindMask(kInt, seen), hn::Load(kInt, distance + i));
      points += hn::CountTrue(kFloat, seen);
    }
    alignas(64) std::int32_t lanes[kN];
    hn::Store(sum, kInt, lanes);
    for (const std::int32_t lane : lanes) {
      all += lane;
    }
  }
  r.contour_sum = static_cast<double>(all) / static_cast<double>(frame.distance_units);
  r.contour_points = static_cast<std::int32_t>(points);
}

}  // namespace telemime::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TELEMIME_SIMD_CONTOUR_INL_H
