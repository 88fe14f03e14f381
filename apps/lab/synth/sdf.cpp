// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/sdf.h"

namespace telemime {
namespace {

float lattice(int x, int y, int z, std::uint32_t seed) {
  std::uint32_t h = seed * 0x9e3779b1u + static_cast<std::uint32_t>(x) * 0x85ebca6bu +
                    static_cast<std::uint32_t>(y) * 0xc2b2ae35u + static_cast<std::uint32_t>(z) * 0x27d4eb2fu;
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 12;
  h *= 0x297a2d39u;
  h ^= h >> 15;
  return static_cast<float>(h) * (2.0f / 4294967296.0f) - 1.0f;
}

float mix(float a, float b, float t) {
  return a + (b - a) * t;
}

}  // namespace

RoundCone round_cone(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float radius_a, float radius_b) {
  RoundCone c;
  c.a = a;
  c.ba = b - a;
  c.radius_a = radius_a;
  c.radius_b = radius_b;
  const float least = std::abs(radius_a - radius_b) * 1.001f + 1e-5f;
  if (const float length = c.ba.norm(); length < least) {
    c.ba = length > 1e-9f ? Eigen::Vector3f(c.ba * (least / length)) : Eigen::Vector3f(0.0f, least, 0.0f);
  }
  c.length2 = c.ba.squaredNorm();
  c.slant2 = c.length2 - (radius_a - radius_b) * (radius_a - radius_b);
  return c;
}

float value_noise(const Eigen::Vector3f& p, std::uint32_t seed) {
  const Eigen::Vector3f cell = p.array().floor();
  const Eigen::Vector3f f = p - cell;
  const Eigen::Vector3f t = f.array() * f.array() * (3.0f - 2.0f * f.array());
  const int x = static_cast<int>(cell.x());
  const int y = static_cast<int>(cell.y());
  const int z = static_cast<int>(cell.z());
  const auto row = [&](int dy, int dz) {
    return mix(lattice(x, y + dy, z + dz, seed), lattice(x + 1, y + dy, z + dz, seed), t.x());
  };
  return mix(mix(row(0, 0), row(1, 0), t.y()), mix(row(0, 1), row(1, 1), t.y()), t.z());
}

}  // namespace telemime
