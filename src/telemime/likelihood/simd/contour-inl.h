// SPDX-License-Identifier: Apache-2.0
// The visible occluding contour: edges where a triangle that faces the camera meets one that does not, a point
// about every pixel, those that nothing hides looked up in the distance map.
#if defined(TELEMIME_SIMD_CONTOUR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TELEMIME_SIMD_CONTOUR_INL_H
#undef TELEMIME_SIMD_CONTOUR_INL_H
#else
#define TELEMIME_SIMD_CONTOUR_INL_H
#endif

#include <cmath>

#include "telemime/likelihood/simd/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace telemime::simd::HWY_NAMESPACE {

// Sets of lanes as long numbers.
inline LaneSet shifted_up(const LaneSet& set, std::uint32_t by) {  // by < 64
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
inline LaneSet lanes_from(std::uint32_t begin, std::uint32_t end) {
  LaneSet out{};
  for (std::uint32_t k = 0; k < out.size(); ++k) {
    const auto below = [k](std::uint32_t lane) {
      return lane >= 64 * (k + 1) ? ~std::uint64_t{0}
                                  : (lane > 64 * k ? (std::uint64_t{1} << (lane - 64 * k)) - 1 : 0);
    };
    out[k] = below(end) & ~below(begin);
  }
  return out;
}

// Points of one edge, from vertex a to vertex b of the segment.
HWY_INLINE void sample_edge(std::size_t a, std::size_t b, Workspace& ws) {
  constexpr float kLongest = 4096.0F;
  const float ax = ws.u[a];
  const float ay = ws.v[a];
  const float aw = ws.w[a];
  const float dx = ws.u[b] - ax;
  const float dy = ws.v[b] - ay;
  const float dw = ws.w[b] - aw;
  const float length = std::sqrt(dx * dx + dy * dy);
  if (!(length < kLongest)) {
    return;
  }
  const std::size_t steps = std::max<std::size_t>(1, static_cast<std::size_t>(length + 0.5F));
  if (ws.count + steps + TileGrid::kPixels > ws.capacity) {
    ws.grow_samples(ws.count + steps + TileGrid::kPixels);
  }
  const FloatVector inverse = number(1.0F / static_cast<float>(steps));
  float* x = ws.samples.data() + ws.count;
  float* y = x + ws.capacity;
  float* w = y + ws.capacity;
  for (std::size_t i = 0; i < steps; i += kN) {
    const FloatVector t = (hn::Iota(kFloat, static_cast<float>(i)) + number(0.5F)) * inverse;
    hn::StoreU(number(ax) + number(dx) * t, kFloat, x + i);
    hn::StoreU(number(ay) + number(dy) * t, kFloat, y + i);
    hn::StoreU(number(aw) + number(dw) * t, kFloat, w + i);
  }
  ws.count += steps;
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
  // At the ends a quadrilateral is one triangle.
  const LaneSet top = lanes_from(0, stride);
  const LaneSet bottom = lanes_from(segment.lanes - stride, segment.lanes);
  LaneSet front1{};
  LaneSet front2{};
  LaneSet known1{};
  LaneSet known2{};
  for (std::size_t k = 0; k < front1.size(); ++k) {
    const auto take = [&](const LaneSet& own, const LaneSet& other, const LaneSet& end) {
      return ((own[k] & ~end[k]) | (other[k] & end[k])) & segment.quads[k];
    };
    front1[k] = take(facing.front[0], facing.front[1], top);
    front2[k] = take(facing.front[1], facing.front[0], bottom);
    known1[k] = take(facing.known[0], facing.known[1], top);
    known2[k] = take(facing.known[1], facing.known[0], bottom);
  }
  // The last vertex of a ring is its first one again: its lane stands for the first quadrilateral.
  const auto wrapped = [&](const LaneSet& set) {
    LaneSet first = set;
    for (std::size_t k = 0; k < first.size(); ++k) {
      first[k] &= segment.first[k];
    }
    LaneSet last = shifted_up(first, stride - 1);
    for (std::size_t k = 0; k < first.size(); ++k) {
      last[k] |= set[k] & ~segment.first[k];
    }
    return last;
  };
  const LaneSet right_front = wrapped(front1);
  const LaneSet right_known = wrapped(known1);
  const LaneSet left_front = shifted_up(front2, 1);
  const LaneSet left_known = shifted_up(known2, 1);
  const LaneSet below_front = shifted_down(front1, stride);
  const LaneSet below_known = shifted_down(known1, stride);
  LaneSet along{};
  LaneSet diagonal{};
  LaneSet ring{};
  for (std::size_t k = 0; k < along.size(); ++k) {
    along[k] = (right_front[k] ^ left_front[k]) & right_known[k] & left_known[k];
    diagonal[k] = (front1[k] ^ front2[k]) & known1[k] & known2[k];
    ring[k] = (front2[k] ^ below_front[k]) & known2[k] & below_known[k];
  }
  sample_edges(
      along, [stride](std::size_t i, Workspace& w) { sample_edge(i, i + stride, w); }, ws);
  sample_edges(
      diagonal, [stride](std::size_t i, Workspace& w) { sample_edge(i + 1, i + stride, w); }, ws);
  sample_edges(
      ring, [stride](std::size_t i, Workspace& w) { sample_edge(i + stride, i + stride + 1, w); }, ws);
}

// Sums in 16 columns whatever the vectors' length, so that the order of additions is the same.
inline void sum_contour(const TiledPlanes& frame, const Workspace& ws, Reductions& r) {
  constexpr float kThickness = 0.015F;
  const TileGrid& grid = frame.grid;
  const float* xs = ws.samples.data();
  const float* ys = xs + ws.capacity;
  const float* ws_ = ys + ws.capacity;
  FloatVector sum[kParts];
  std::int32_t points = 0;
  for (FloatVector& part : sum) {
    part = hn::Zero(kFloat);
  }
  const FloatVector low = number(-0.5F);
  const FloatVector right = number(static_cast<float>(grid.width) - 0.5F);
  const FloatVector bottom = number(static_cast<float>(grid.height) - 0.5F);
  const FloatVector half = number(0.5F);
  const IntVector three = hn::Set(kInt, 3);
  const IntVector columns = hn::Set(kInt, grid.columns);
  const auto* depth = reinterpret_cast<const float*>(ws.depth);
  const auto total = static_cast<std::int32_t>(ws.count);
  for (std::int32_t i = 0; i < total; i += TileGrid::kPixels) {
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t at = static_cast<std::size_t>(i) + part * kN;
      const FloatVector x = hn::LoadU(kFloat, xs + at);
      const FloatVector y = hn::LoadU(kFloat, ys + at);
      const FloatVector w = hn::LoadU(kFloat, ws_ + at);
      const IntVector left_over = hn::Iota(kInt, static_cast<std::int32_t>(at));
      FloatMask seen = hn::And(hn::And(x > low, x < right), hn::And(y > low, y < bottom));
      seen = hn::And(seen, hn::RebindMask(kFloat, left_over < hn::Set(kInt, total)));
      const IntVector px = hn::ConvertTo(kInt, hn::IfThenElseZero(seen, x + half));
      const IntVector py = hn::ConvertTo(kInt, hn::IfThenElseZero(seen, y + half));
      const IntVector tile = hn::ShiftRight<2>(py) * columns + hn::ShiftRight<2>(px);
      const IntVector pixel = hn::ShiftLeft<4>(tile) + hn::ShiftLeft<2>(py & three) + (px & three);
      const FloatVector nearest = hn::GatherIndex(kFloat, depth, pixel);
      const FloatVector distance = hn::GatherIndex(kFloat, frame.distance.data(), pixel);
      seen = hn::AndNot(is_hidden(nearest, w, number(kThickness)), seen);
      sum[part] = sum[part] + hn::IfThenElseZero(seen, distance);
      points += static_cast<std::int32_t>(hn::CountTrue(kFloat, seen));
    }
  }
  alignas(64) float columns_sum[TileGrid::kPixels];
  for (std::size_t part = 0; part < kParts; ++part) {
    hn::Store(sum[part], kFloat, columns_sum + part * kN);
  }
  double all = 0.0;
  for (const float column : columns_sum) {
    all += static_cast<double>(column);
  }
  r.contour_sum = all;
  r.contour_points = points;
}

}  // namespace telemime::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TELEMIME_SIMD_CONTOUR_INL_H
