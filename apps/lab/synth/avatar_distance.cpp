// SPDX-License-Identifier: Apache-2.0
// Distances and colours of an avatar (avatar.cpp builds it).
#include <limits>

#include "lab/synth/avatar.h"

namespace telemime {
namespace {

using Eigen::Vector3f;

// Half width, half depth and middle of the trunk in the chest's frame, m, from 0.16 m under the root (fifth
// lumbar vertebra) upward in steps of 0.08 m, for a spine of 0.5 m.
constexpr float kTrunkFoot = -0.16f;
constexpr float kTrunkStep = 0.08f;
struct TrunkRing {
  float width, depth, middle;
};
constexpr std::array<TrunkRing, 9> kTrunk = {{{0.168f, 0.120f, 0.030f},
                                              {0.170f, 0.121f, 0.032f},
                                              {0.160f, 0.113f, 0.034f},
                                              {0.147f, 0.105f, 0.036f},
                                              {0.144f, 0.104f, 0.036f},
                                              {0.153f, 0.111f, 0.034f},
                                              {0.162f, 0.117f, 0.028f},
                                              {0.158f, 0.108f, 0.018f},
                                              {0.120f, 0.080f, 0.010f}}};

float catmull(float a, float b, float c, float d, float t) {
  return b + 0.5f * t * (c - a + t * (2.0f * a - 5.0f * b + 4.0f * c - d + t * (3.0f * (b - c) + d - a)));
}

TrunkRing trunk_ring(float y) {
  const float place =
      std::clamp((y - kTrunkFoot) / kTrunkStep, 0.0f, static_cast<float>(kTrunk.size()) - 1.001f);
  const auto i = static_cast<std::size_t>(place);
  const float t = place - static_cast<float>(i);
  const TrunkRing& a = kTrunk[i == 0 ? 0 : i - 1];
  const TrunkRing& b = kTrunk[i];
  const TrunkRing& c = kTrunk[i + 1];
  const TrunkRing& d = kTrunk[std::min(i + 2, kTrunk.size() - 1)];
  return {catmull(a.width, b.width, c.width, d.width, t), catmull(a.depth, b.depth, c.depth, d.depth, t),
          catmull(a.middle, b.middle, c.middle, d.middle, t)};
}

float torso_distance(const Avatar& avatar, const BodyPart& part, const Vector3f& p) {
  const TrunkRing ring = trunk_ring(p.y());
  const float w = ring.width * avatar.girth;
  const float d = ring.depth * avatar.girth;
  const float z = p.z() - ring.middle;
  const float k0 = std::hypot(p.x() / w, z / d);
  const float k1 = std::hypot(p.x() / (w * w), z / (d * d));
  float trunk = k1 < 1e-5f ? -d : k0 * (k0 - 1.0f) / k1;
  trunk = smooth_intersection(trunk, p.y() - 0.482f, 0.09f);
  trunk = smooth_intersection(trunk, -0.115f - p.y(), 0.01f);
  const auto bust = static_cast<float>(avatar.look.bust);
  if (bust > 0.0f) {
    const Vector3f at = Vector3f(std::abs(p.x()), p.y(), p.z()) - Vector3f(0.074f, 0.300f, 0.092f);
    trunk = smooth_union(trunk, ellipsoid(at, Vector3f(0.058f, 0.058f, 0.046f + 0.020f * bust)), 0.050f);
  }
  for (const RoundCone& cone : part.cones) {
    trunk = smooth_union(trunk, distance(cone, p), 0.05f);
  }
  // The neck hole, its rim a thin roll.
  const Vector3f from_hole = p - Vector3f(0.0f, 0.470f, 0.020f);
  const Vector3f axis(0.0f, 0.955f, 0.297f);
  const float along = from_hole.dot(axis);
  const float from_axis = (from_hole - along * axis).norm();
  return smooth_intersection(trunk, std::min(0.0600f - from_axis, along + 0.03f), 0.008f);
}

float part_distance(const Avatar& avatar, const BodyPart& part, const Vector3f& p) {
  float d = 0.0f;
  if (part.kind == BodyPart::Kind::limb) {
    d = distance(part.cones.front(), p);
    for (std::size_t i = 1; i < part.cones.size(); ++i) {
      d = smooth_union(d, distance(part.cones[i], p), part.blend);
    }
  } else {
    const Vector3f local = part.rotation * (p - part.origin) / part.scale;
    switch (part.kind) {
      case BodyPart::Kind::torso:
        d = torso_distance(avatar, part, local) * part.scale;
        break;
      case BodyPart::Kind::head:
        d = face_distance(avatar.head, local) * part.scale;
        break;
      case BodyPart::Kind::hair:
        d = hair_distance(avatar.head, local) * part.scale;
        break;
      case BodyPart::Kind::hand:
        d = distance(part.hand, local) * part.scale;
        break;
      case BodyPart::Kind::limb:
        break;
    }
  }
  if (!part.hem.normal.isZero()) {
    d = smooth_intersection(d, part.hem.normal.dot(p - part.hem.at), 0.004f);
  }
  return d;
}

Vector3f shirt_colour(const Avatar& avatar, const BodyPart& part, const Vector3f& local) {
  const Look& look = avatar.look;
  Vector3f colour = look.shirt;
  if (look.striped) {
    // On the trunk across it, on a sleeve round it.
    const float phase = (part.kind == BodyPart::Kind::torso ? local.y() : -local.y()) / 0.046f;
    const float saw = std::abs(phase - std::floor(phase) - 0.5f);
    colour += (look.shirt2 - colour) * smooth_step(0.235f, 0.265f, saw);
  }
  if (part.kind == BodyPart::Kind::torso) {
    const Vector3f from_hole = local - Vector3f(0.0f, 0.470f, 0.020f);
    const Vector3f axis(0.0f, 0.955f, 0.297f);
    const float from_axis = (from_hole - from_hole.dot(axis) * axis).norm();
    colour *= 1.0f - 0.25f * (1.0f - smooth_step(0.0735f, 0.0755f, from_axis));
  }
  const float weave = value_noise(local * 900.0f, look.texture + 1);
  return colour * (1.0f + 0.10f * value_noise(local * 25.0f, look.texture) + 0.06f * weave);
}

}  // namespace

PartSelection parts_along(const Avatar& avatar, const Vector3f& origin, const Vector3f& direction,
                          float margin) {
  PartSelection s;
  s.near = std::numeric_limits<float>::max();
  for (const BodyPart& part : avatar.parts) {
    const Vector3f to = part.centre - origin;
    const float along = to.dot(direction);
    const float reach = part.radius + margin;
    const float gap2 = reach * reach - (to.squaredNorm() - along * along);
    if (gap2 <= 0.0f || s.count == PartSelection::kMost) {
      continue;
    }
    const float half = std::sqrt(gap2);
    if (along + half <= 0.0f) {
      continue;
    }
    s.parts[s.count++] = &part;
    s.near = std::min(s.near, std::max(along - half, 0.0f));
    s.far = std::max(s.far, along + half);
  }
  return s;
}

PartSelection parts_near(const Avatar& avatar, const Vector3f& point, float margin) {
  PartSelection s;
  for (const BodyPart& part : avatar.parts) {
    const float reach = part.radius + margin;
    if ((part.centre - point).squaredNorm() < reach * reach && s.count < PartSelection::kMost) {
      s.parts[s.count++] = &part;
    }
  }
  return s;
}

BodySample sample_body(const Avatar& avatar, const PartSelection& selection, const Vector3f& p) {
  BodySample best;
  std::size_t i = 0;
  while (i < selection.count) {
    const std::uint8_t chain = selection.parts[i]->chain;
    float whole = 1e9f;
    float nearest = 1e9f;
    const BodyPart* part = nullptr;
    for (; i < selection.count && selection.parts[i]->chain == chain; ++i) {
      const BodyPart& candidate = *selection.parts[i];
      // Far from its bounding ball the distance to the ball is enough.
      const float bound = (p - candidate.centre).norm() - candidate.radius;
      const float d = bound > candidate.blend + 0.03f ? bound : part_distance(avatar, candidate, p);
      if (d < nearest) {
        nearest = d;
        part = &candidate;
      }
      whole = whole > 1e8f ? d : smooth_union(whole, d, candidate.blend);
    }
    if (whole < best.distance) {
      best = {whole, part};
    }
  }
  return best;
}

Vector3f surface_colour(const Avatar& avatar, const BodyPart& part, const Vector3f& p) {
  const Look& look = avatar.look;
  const Vector3f local = part.rotation * (p - part.origin) / part.scale;
  switch (part.surface) {
    case Surface::head:
      if (part.kind == BodyPart::Kind::head) {
        return face_colour(look, local);
      }
      break;
    case Surface::shirt:
      return shirt_colour(avatar, part, local);
    case Surface::hair: {
      const float strands =
          value_noise(Vector3f(local.x() * 420.0f, local.y() * 60.0f, local.z() * 160.0f), look.texture);
      return look.hair * (1.0f + 0.45f * strands);
    }
    case Surface::trousers:
      return look.trousers * (1.0f + 0.15f * value_noise(p * 300.0f, look.texture));
    case Surface::arm:
    case Surface::background:
      break;
  }
  Vector3f mottled = look.skin * (0.97f + 0.05f * value_noise(local * 70.0f, look.texture + 2));
  if (part.kind == BodyPart::Kind::hand) {
    // Palms are paler, fingertips and knuckles redder.
    const float palm = smooth_step(-0.002f, -0.012f, local.z());
    const float tips = smooth_step(0.110f, 0.170f, local.y());
    return mottled.cwiseProduct(
        Vector3f(1.0f + 0.04f * palm, 0.97f - 0.10f * tips + 0.03f * palm, 0.96f - 0.09f * tips));
  }
  return mottled;
}

}  // namespace telemime
