// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/avatar.h"

#include <array>
#include <cmath>

#include "telemime/body/arm_parts.h"

namespace telemime {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

using Rgb = std::array<float, 3>;

template <std::size_t N>
std::size_t pick(Random& random, const std::array<Rgb, N>& table) {
  return random.below(static_cast<std::uint32_t>(table.size()));
}

Vector3f linear(const Rgb& c) {
  return linear_colour(c[0], c[1], c[2]);
}

constexpr std::array<Rgb, 5> kSkins = {
    {{226, 178, 150}, {216, 164, 134}, {198, 146, 114}, {170, 118, 88}, {128, 86, 64}}};
constexpr std::array<Rgb, 5> kShirts = {
    {{34, 88, 178}, {22, 132, 142}, {36, 128, 72}, {104, 52, 150}, {48, 62, 128}}};
constexpr std::array<Rgb, 4> kHair = {{{30, 24, 22}, {58, 40, 28}, {84, 60, 40}, {22, 22, 26}}};
constexpr std::array<Rgb, 3> kTrousers = {{{38, 42, 54}, {44, 44, 46}, {34, 40, 66}}};
constexpr std::array<Rgb, 3> kEyes = {{{66, 46, 34}, {62, 78, 88}, {70, 74, 48}}};

// Ball round all cones of a limb, grown by what their seams may bulge.
void bound(BodyPart& part) {
  Vector3f low = part.cones.front().a;
  Vector3f high = low;
  for (const RoundCone& cone : part.cones) {
    for (const Vector3f& end : {cone.a, Vector3f(cone.a + cone.ba)}) {
      low = low.cwiseMin(end);
      high = high.cwiseMax(end);
    }
  }
  part.centre = 0.5f * (low + high);
  part.radius = 0.0f;
  for (const RoundCone& cone : part.cones) {
    part.radius = std::max({part.radius, (cone.a - part.centre).norm() + cone.radius_a,
                            (cone.a + cone.ba - part.centre).norm() + cone.radius_b});
  }
  part.radius += 0.25f * part.blend;
}

// Rows: the axes of a limb's frame, y from a to b, z as near to `front` as can be.
Matrix3f limb_axes(const Vector3f& a, const Vector3f& b, const Vector3f& front) {
  const Vector3f y = (b - a).normalized();
  const Vector3f x = y.cross(front).normalized();
  Matrix3f rows;
  rows << x.transpose(), y.transpose(), x.cross(y).transpose();
  return rows;
}

struct Chains {
  std::uint8_t chain;
  Surface surface;
  float blend;
};

BodyPart limb(const Chains& of, std::vector<RoundCone> cones, const Vector3f& front) {
  BodyPart part;
  part.chain = of.chain;
  part.surface = of.surface;
  part.blend = of.blend;
  part.cones = std::move(cones);
  part.origin = part.cones.front().a;
  part.rotation = limb_axes(part.origin, part.cones.back().a + part.cones.back().ba, front);
  bound(part);
  return part;
}

BodyPart framed(BodyPart::Kind kind, const Chains& of, const Matrix3f& camera_from_local,
                const Vector3f& origin, float scale, const Vector3f& ball_centre, float ball_radius) {
  BodyPart part;
  part.kind = kind;
  part.chain = of.chain;
  part.surface = of.surface;
  part.blend = of.blend;
  part.rotation = camera_from_local.transpose();
  part.origin = origin;
  part.scale = scale;
  part.centre = origin + camera_from_local * ball_centre * scale;
  part.radius = ball_radius * scale;
  return part;
}

struct ArmPoints {
  Vector3f shoulder, elbow, wrist;
};

ArmPoints arm_points(const JointPositions& joints, const ArmParts& arm) {
  return {joints[arm.shoulder].cast<float>(), joints[arm.elbow].cast<float>(),
          joints[arm.wrist].cast<float>()};
}

void add_arm(Avatar& avatar, const ActorKinematics& k, std::size_t side, const Vector3f& front) {
  const ArmPoints a = arm_points(k.joints, kArmParts[side]);
  const float g = std::sqrt(avatar.girth);
  const Chains chain{static_cast<std::uint8_t>(1 + side), Surface::arm, 0.012f};
  const Vector3f belly = a.elbow + 0.36f * (a.wrist - a.elbow);
  avatar.parts.push_back(limb(chain, {round_cone(a.shoulder, a.elbow, 0.0450f * g, 0.0375f * g)}, front));
  avatar.parts.push_back(limb(chain,
                              {round_cone(a.elbow, belly, 0.0350f * g, 0.0355f * g),
                               round_cone(belly, a.wrist, 0.0355f * g, 0.0240f * g)},
                              front));
  const auto scale = static_cast<float>(avatar.look.build.hand) / kHandKnuckle;
  BodyPart hand = framed(BodyPart::Kind::hand, chain, k.camera_from_hand[side].cast<float>(), a.wrist, scale,
                         {0.0f, 0.085f, 0.0f}, kHandReach);
  hand.hand = hand_shape(k.curl[side]);
  avatar.parts.push_back(hand);
}

void add_sleeve(Avatar& avatar, const ActorKinematics& k, std::size_t side, const Vector3f& front) {
  const ArmPoints a = arm_points(k.joints, kArmParts[side]);
  const float g = std::sqrt(avatar.girth);
  const Chains chain{3, Surface::shirt, 0.035f};
  const auto upper_end = static_cast<float>(std::min(avatar.look.sleeve, 1.0));
  const Vector3f end = a.shoulder + upper_end * (a.elbow - a.shoulder);
  // A sleeve hangs loose toward its hem.
  const float wide = avatar.look.sleeve > 1.0 ? 0.0415f : 0.0540f;
  BodyPart upper = limb(chain, {round_cone(a.shoulder, end, 0.0500f * g, wide * g)}, front);
  if (avatar.look.sleeve <= 1.0) {
    upper.hem = {end, (a.elbow - a.shoulder).normalized()};
    avatar.parts.push_back(upper);
    return;
  }
  avatar.parts.push_back(upper);
  const auto lower_end = static_cast<float>(std::min(avatar.look.sleeve - 1.0, 0.98));
  const Vector3f hem = a.elbow + lower_end * (a.wrist - a.elbow);
  const Vector3f belly = a.elbow + 0.36f * (a.wrist - a.elbow);
  BodyPart lower = limb(chain,
                        {round_cone(a.elbow, belly, 0.0405f * g, 0.0425f * g),
                         round_cone(belly, hem, 0.0425f * g, 0.0325f * g)},
                        front);
  lower.hem = {hem, (a.wrist - a.elbow).normalized()};
  avatar.parts.push_back(lower);
}

void add_torso(Avatar& avatar, const ActorKinematics& k) {
  const Matrix3f camera_from_chest = k.camera_from_chest.linear().cast<float>();
  const Vector3f root = k.joints[Joint::root].cast<float>();
  const auto scale = static_cast<float>(avatar.look.build.spine) / 0.5f;
  const float g = std::sqrt(avatar.girth);
  BodyPart torso = framed(BodyPart::Kind::torso, {3, Surface::shirt, 0.035f}, camera_from_chest, root, scale,
                          {0.0f, 0.19f, 0.03f}, 0.385f);
  for (const Side side : {Side::left, Side::right}) {
    const Vector3f shoulder =
        torso.rotation * (arm_points(k.joints, arm_parts(side)).shoulder - root) / scale;
    const float s = side == Side::left ? 1.0f : -1.0f;
    // Trapezius, pectoral and broad back muscles follow the shoulder.
    torso.cones.push_back(round_cone({s * 0.030f, 0.468f, 0.002f}, shoulder, 0.040f * g, 0.0430f * g));
    torso.cones.push_back(round_cone({s * 0.080f, 0.355f, 0.072f}, shoulder, 0.042f * g, 0.0360f * g));
    torso.cones.push_back(round_cone({s * 0.106f, 0.290f, -0.005f}, shoulder, 0.042f * g, 0.0360f * g));
  }
  avatar.parts.push_back(torso);
}

void add_legs(Avatar& avatar, const Vector3f& root, const Vector3f& front) {
  const float g = avatar.girth;
  const auto at = [&](float x, float up, float forward) {
    return Vector3f(root + Vector3f(x, -up, -forward));
  };
  std::vector<RoundCone> cones{
      round_cone(at(-0.07f, -0.11f, 0.02f), at(0.07f, -0.11f, 0.02f), 0.112f * g, 0.1119f * g)};
  for (const float s : {1.0f, -1.0f}) {
    cones.push_back(
        round_cone(at(s * 0.085f, -0.115f, 0.04f), at(s * 0.17f, -0.125f, 0.45f), 0.086f * g, 0.062f * g));
    cones.push_back(
        round_cone(at(s * 0.17f, -0.125f, 0.45f), at(s * 0.17f, -0.52f, 0.42f), 0.060f * g, 0.050f * g));
  }
  avatar.parts.push_back(limb({4, Surface::trousers, 0.02f}, std::move(cones), front));
}

}  // namespace

Vector3f linear_colour(float red, float green, float blue) {
  const Vector3f c = Vector3f(red, green, blue) / 255.0f;
  return c.cwiseProduct(c);
}

Look random_look(Random& random) {
  Look look;
  const double height = random.uniform(0.95, 1.04);
  look.build = scaled_build(height, random.uniform(0.94, 1.08));
  look.skin = linear(kSkins[pick(random, kSkins)]);
  look.shirt_index = static_cast<int>(pick(random, kShirts));
  look.shirt = linear(kShirts[static_cast<std::size_t>(look.shirt_index)]);
  look.hair = linear(kHair[pick(random, kHair)]);
  look.trousers = linear(kTrousers[pick(random, kTrousers)]);
  look.eyes = linear(kEyes[pick(random, kEyes)]);
  look.style = static_cast<HairStyle>(random.below(3));
  look.bust = look.style == HairStyle::bob ? random.uniform(0.5, 1.0) : random.uniform(0.0, 0.25);
  look.face_width = static_cast<float>(random.uniform(0.96, 1.04));
  look.jaw = static_cast<float>(random.uniform(0.95, 1.05));
  look.sleeve = random.uniform(0.52, 0.66);
  look.texture = static_cast<std::uint32_t>(random.bits());
  return look;
}

Avatar make_avatar(const Look& look, const ActorKinematics& k) {
  Avatar avatar;
  avatar.look = look;
  avatar.head = {look.face_width, look.jaw, look.style};
  avatar.girth = static_cast<float>(look.build.girth);
  const Matrix3f camera_from_chest = k.camera_from_chest.linear().cast<float>();
  const Vector3f front = camera_from_chest.col(2);
  const Vector3f root = k.joints[Joint::root].cast<float>();
  const Vector3f skull = k.joints[Joint::head].cast<float>();
  const auto head_scale = static_cast<float>(look.build.head_up) / kHeadCrown;
  const Matrix3f camera_from_head = k.camera_from_head.linear().cast<float>();

  const Chains head{0, Surface::head, 0.028f};
  avatar.parts.push_back(framed(BodyPart::Kind::head, head, camera_from_head, skull, head_scale,
                                {0.0f, 0.035f, 0.0f}, kHeadReach));
  const auto spine = static_cast<float>(look.build.spine);
  const float g = std::sqrt(avatar.girth);
  const Vector3f neck_foot = root + camera_from_chest * Vector3f(0.0f, spine - 0.055f, 0.018f);
  const Vector3f neck_top = skull + camera_from_head * Vector3f(0.0f, 0.0f, 0.002f);
  avatar.parts.push_back(limb(head, {round_cone(neck_foot, neck_top, 0.0540f * g, 0.0465f * g)}, front));
  for (std::size_t side = 0; side < 2; ++side) {
    add_arm(avatar, k, side, front);
  }
  add_torso(avatar, k);
  for (std::size_t side = 0; side < 2; ++side) {
    add_sleeve(avatar, k, side, front);
  }
  add_legs(avatar, root, front);
  avatar.parts.push_back(framed(BodyPart::Kind::hair, {5, Surface::hair, 0.01f}, camera_from_head, skull,
                                head_scale, {0.0f, 0.035f, 0.0f}, kHeadReach));
  return avatar;
}

}  // namespace telemime
