// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace telemime {

/// Signed distances of simple solids (Hart, "Sphere tracing", The Visual Computer 12, 1996): negative inside,
/// metres, and never more than the true distance outside, so that a ray may safely step by them.

/// The hull of two balls: a limb. Exact distance; the balls may differ in size but neither may hold the
/// other.
struct RoundCone {
  Eigen::Vector3f a{0.0f, 0.0f, 0.0f};   ///< centre of the first ball
  Eigen::Vector3f ba{0.0f, 1.0f, 0.0f};  ///< from the first centre to the second
  float radius_a = 0.0f;                 ///< m
  float radius_b = 0.0f;
  float length2 = 1.0f;  ///< |ba|^2
  float slant2 = 1.0f;   ///< |ba|^2 - (radius_a - radius_b)^2, positive
};

/// The round cone with balls at `a` and `b`. When one ball holds the other the distance between the centres
/// is stretched by the least that makes the cone valid.
RoundCone round_cone(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float radius_a, float radius_b);

/// Distance (m) from p to the round cone.
inline float distance(const RoundCone& c, const Eigen::Vector3f& p) {
  const Eigen::Vector3f pa = p - c.a;
  const float y = pa.dot(c.ba);
  const float z = y - c.length2;
  const float x2 = (pa * c.length2 - c.ba * y).squaredNorm();
  const float y2 = y * y * c.length2;
  const float z2 = z * z * c.length2;
  const float taper = c.radius_a - c.radius_b;
  const float k = std::copysign(taper * taper * x2, taper);
  const float inverse = 1.0f / c.length2;
  if (std::copysign(c.slant2 * z2, z) > k) {
    return std::sqrt(x2 + z2) * inverse - c.radius_b;
  }
  if (std::copysign(c.slant2 * y2, y) < k) {
    return std::sqrt(x2 + y2) * inverse - c.radius_a;
  }
  return (std::sqrt(x2 * c.slant2 * inverse) + y * taper) * inverse - c.radius_a;
}

/// Estimate (m, exact on the surface, first order near it) of the distance from p to an axis-parallel
/// ellipsoid round the origin with these radii (m).
inline float ellipsoid(const Eigen::Vector3f& p, const Eigen::Vector3f& radii) {
  const Eigen::Vector3f q = p.cwiseQuotient(radii);
  const float k0 = q.norm();
  const float k1 = q.cwiseQuotient(radii).norm();
  return k1 < 1e-6f ? -radii.minCoeff() : k0 * (k0 - 1.0f) / k1;
}

/// Union of two solids whose seam is rounded over k metres (polynomial smooth minimum). At most k / 4 below
/// the plain minimum, and equal to it where the distances differ by more than k.
inline float smooth_union(float a, float b, float k) {
  const float h = std::max(k - std::abs(a - b), 0.0f) / k;
  return std::min(a, b) - h * h * k * 0.25f;
}

/// Intersection with a rounded edge; take -b to cut the solid b away.
inline float smooth_intersection(float a, float b, float k) {
  return -smooth_union(-a, -b, k);
}

/// 0 below `low`, 1 above `high`, a smooth step between.
inline float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// Smooth noise in [-1, 1] over space (one lattice point per unit), the same for the same seed.
float value_noise(const Eigen::Vector3f& p, std::uint32_t seed);

}  // namespace telemime
