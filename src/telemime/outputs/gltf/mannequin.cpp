// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/gltf/humanoid.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace telemime {
namespace {

using Eigen::Vector3d;

constexpr int kSides = 12;
constexpr int kRings = 8;

/// Half widths of a piece, fractions of stature: along `across` and along the third direction; and how far it
/// reaches past both ends of the bone.
struct Girth {
  Vector3d across;
  double wide, deep, past;
};

Girth girth(HumanBone bone) {
  using Widths = std::array<double, 3>;
  constexpr std::array<Widths, 5> kTrunk = {{{0.088, 0.062, 0.040},
                                             {0.080, 0.056, 0.025},
                                             {0.092, 0.060, 0.015},
                                             {0.032, 0.032, 0.010},
                                             {0.045, 0.052, 0.025}}};
  constexpr std::array<Widths, 4> kArm = {
      {{0.026, 0.030, 0.005}, {0.029, 0.029, 0.015}, {0.023, 0.025, 0.012}, {0.012, 0.025, 0.018}}};
  constexpr std::array<Widths, 3> kLeg = {
      {{0.044, 0.046, 0.015}, {0.033, 0.036, 0.012}, {0.026, 0.018, 0.014}}};
  const auto index = static_cast<std::size_t>(bone);
  constexpr auto kFirstArm = static_cast<std::size_t>(HumanBone::l_shoulder);
  constexpr auto kFirstLeg = static_cast<std::size_t>(HumanBone::l_upper_leg);
  const bool arm = index >= kFirstArm && index < kFirstLeg;
  const auto [wide, deep, past] = arm                  ? kArm.at((index - kFirstArm) % kArm.size())
                                  : index >= kFirstLeg ? kLeg.at((index - kFirstLeg) % kLeg.size())
                                                       : kTrunk.at(index);
  return {arm ? Vector3d::UnitY() : Vector3d::UnitX(), wide, deep, past};
}

struct Pieces {
  std::vector<float> positions, normals;
  std::vector<std::uint8_t> joints;
  std::vector<std::uint16_t> weights;
  std::vector<std::uint32_t> indices;

  void vertex(std::size_t bone, const Vector3d& place, const Vector3d& normal) {
    const Eigen::Vector3f p = place.cast<float>();
    const Eigen::Vector3f n = normal.cast<float>().normalized();
    positions.insert(positions.end(), p.begin(), p.end());
    normals.insert(normals.end(), n.begin(), n.end());
    joints.insert(joints.end(), {static_cast<std::uint8_t>(bone), 0, 0, 0});
    weights.insert(weights.end(), {65535, 0, 0, 0});
  }

  /// A rounded bar from `from` to `to`: the sphere of rings, raised to a superellipse along the bone.
  void add(std::size_t bone, const Vector3d& from, const Vector3d& to, const Girth& g, double stature) {
    const auto first = static_cast<std::uint32_t>(positions.size() / 3);
    const Vector3d middle = 0.5 * (from + to);
    const Vector3d along = (to - from).normalized();
    const Vector3d wide = (g.across - g.across.dot(along) * along).normalized();
    const Vector3d deep = along.cross(wide);
    const double half = 0.5 * (to - from).norm() + g.past * stature;
    const auto point = [&](double turn, double height) -> Vector3d {  // height: angle from -pi/2 to pi/2
      const double t = std::sin(height);
      const double r = std::sqrt(std::sqrt(1.0 - t * t * t * t));
      return r * stature * (g.wide * std::cos(turn) * wide + g.deep * std::sin(turn) * deep) +
             half * t * along;
    };
    for (int ring = 1; ring < kRings; ++ring) {
      const double height = std::numbers::pi * (static_cast<double>(ring) / kRings - 0.5);
      for (int side = 0; side < kSides; ++side) {
        const double turn = 2.0 * std::numbers::pi * side / kSides;
        constexpr double kStep = 1e-4;
        const Vector3d u = point(turn + kStep, height) - point(turn - kStep, height);
        const Vector3d v = point(turn, height + kStep) - point(turn, height - kStep);
        vertex(bone, middle + point(turn, height), u.cross(v));
      }
    }
    vertex(bone, middle - half * along, -along);
    vertex(bone, middle + half * along, along);
    constexpr std::uint32_t kCount = kSides;
    const auto at = [&](std::uint32_t ring, std::uint32_t side) {
      return first + ring * kCount + side % kCount;
    };
    constexpr std::uint32_t kLast = kRings - 2;
    const std::uint32_t bottom = first + (kLast + 1) * kCount;
    for (std::uint32_t side = 0; side < kCount; ++side) {
      indices.insert(indices.end(), {bottom, at(0, side + 1), at(0, side)});
      for (std::uint32_t ring = 0; ring < kLast; ++ring) {
        indices.insert(indices.end(), {at(ring, side), at(ring, side + 1), at(ring + 1, side)});
        indices.insert(indices.end(), {at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side)});
      }
      indices.insert(indices.end(), {bottom + 1, at(kLast, side), at(kLast, side + 1)});
    }
  }
};

}  // namespace

std::size_t add_mannequin(GltfDocument& document, const HumanoidSkeleton& skeleton, double stature) {
  Pieces pieces;
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    const auto bone = static_cast<HumanBone>(b);
    Girth size = girth(bone);
    if (skeleton.fingers && (bone == HumanBone::l_hand || bone == HumanBone::r_hand)) {
      size.past = 0.006;  // a palm only
    }
    pieces.add(b, skeleton.position[b], skeleton.end[b], size, stature);
  }
  constexpr std::array<double, 3> kFingerRadius = {0.0058, 0.0052, 0.0046};
  for (std::size_t b = 0; skeleton.fingers && b < kFingerBoneCount; ++b) {
    const Vector3d& wrist = skeleton.position[static_cast<std::size_t>(hand_of_finger_bone(b))];
    const double radius = kFingerRadius.at(b % 3) * (b / 3 % kFingerCount == 0 ? 1.15 : 1.0);
    pieces.add(finger_node(b), wrist + skeleton.fingers->position[b], wrist + skeleton.fingers->end[b],
               {Vector3d::UnitY(), radius, radius, 0.5 * radius}, stature);
  }
  const std::size_t material = add_to(
      document, "materials",
      {{"name", "mannequin"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.55, 0.62, 0.70, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.6}}}});
  nlohmann::ordered_json primitive;
  primitive["attributes"] = {
      {"POSITION", add_accessor(document, pieces.positions, "VEC3", GltfTarget::vertices, true)},
      {"NORMAL", add_accessor(document, pieces.normals, "VEC3", GltfTarget::vertices)},
      {"JOINTS_0", add_accessor(document, pieces.joints)},
      {"WEIGHTS_0", add_accessor(document, pieces.weights)}};
  primitive["indices"] = add_indices(document, pieces.indices);
  primitive["material"] = material;
  return add_to(document, "meshes", {{"name", "mannequin"}, {"primitives", {primitive}}});
}

}  // namespace telemime
