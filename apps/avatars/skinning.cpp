// SPDX-License-Identifier: Apache-2.0
#include "avatars/skinning.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "telemime/outputs/gltf/humanoid.h"

namespace telemime {
namespace {

// 0 up to `from`, 1 after `to`, smooth between.
double ramp(double value, double from, double to) {
  const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

class Weights {
 public:
  double& operator[](HumanBone bone) { return all_[static_cast<std::size_t>(bone)]; }

  /// Gives a share of what `from` has to `to`.
  void pass(HumanBone from, HumanBone to, double share) {
    pass(static_cast<std::size_t>(from), static_cast<std::size_t>(to), share);
  }
  void pass(std::size_t from, std::size_t to, double share) {
    const double given = share * all_.at(from);
    all_.at(from) -= given;
    all_.at(to) += given;
  }

  SkinWeights strongest() const {
    std::array<std::size_t, kSkinBoneCount> order{};
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return all_[a] > all_[b]; });
    SkinWeights result;
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum += all_[order[i]];
    }
    for (std::size_t i = 0; i < 4; ++i) {
      result.weight[i] = all_[order[i]] / sum;
      result.bone[i] = result.weight[i] > 0.0 ? static_cast<std::uint8_t>(order[i]) : std::uint8_t{0};
    }
    return result;
  }

 private:
  std::array<double, kSkinBoneCount> all_{};
};

double distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  return (p - a - std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0) * along).norm();
}

// The fingers take what the hand has: each point follows the finger that is nearest.
void add_fingers(const FingerSkeleton& fingers, Side side, const Eigen::Vector3d& from_wrist, double s,
                 Weights& w) {
  constexpr double kJoint = 0.007;  // m, half of the skin that bends at a joint
  const auto hand = static_cast<std::size_t>(side == Side::left ? HumanBone::l_hand : HumanBone::r_hand);
  std::size_t nearest = 0;
  std::array<double, kFingerCount> distance{};
  double palm = 1.0;
  for (std::size_t f = 0; f < kFingerCount; ++f) {
    distance[f] = 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t b = finger_bone(side, f, i);
      distance[f] =
          std::min(distance[f], distance_to_segment(from_wrist, fingers.position[b], fingers.end[b]));
    }
    if (f > 0) {
      const Eigen::Vector3d& knuckle = fingers.position[finger_bone(side, f, 0)];
      palm = std::min(palm, distance_to_segment(from_wrist, Eigen::Vector3d::Zero(), knuckle));
    }
    nearest = distance[f] < distance[nearest] ? f : nearest;
  }
  // The ball of the thumb is between it and the palm.
  const double mine = nearest == 0 ? ramp(palm - distance[0], -0.006 * s, 0.014 * s) : 1.0;
  std::size_t from = hand;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t b = finger_bone(side, nearest, i);
    const double along =
        (from_wrist - fingers.position[b]).dot((fingers.end[b] - fingers.position[b]).normalized());
    const double bend = kJoint * s * (i == 0 ? 1.6 : 1.0);
    w.pass(from, finger_node(b), (i == 0 ? mine : 1.0) * ramp(along, -bend, bend));
    from = finger_node(b);
  }
}

}  // namespace

SkinWeights rigid(HumanBone bone) {
  return {{static_cast<std::uint8_t>(bone), 0, 0, 0}, {1.0, 0.0, 0.0, 0.0}};
}

SkinWeights skin_weights(const Figure& f, const Eigen::Vector3d& p) {
  using enum HumanBone;
  const double s = f.scale;
  const double x = std::abs(p.x());
  const bool left = p.x() >= 0.0;
  const auto y_of = [&](HumanBone bone) { return f.at(bone).y(); };
  const Eigen::Vector3d& shoulder = f.at(l_upper_arm);
  Weights w;
  w[hips] = 1.0;
  w.pass(hips, spine, ramp(p.y(), y_of(spine) - 0.07 * s, y_of(spine) + 0.06 * s));
  w.pass(spine, chest, ramp(p.y(), y_of(chest) - 0.10 * s, y_of(chest) + 0.08 * s));
  // The neck: not the slope of the shoulders beside it.
  const double beside = 1.0 - ramp(x, 0.055 * s, 0.100 * s);
  w.pass(chest, neck, beside * ramp(p.y(), y_of(neck) - 0.040 * s, y_of(neck) + 0.035 * s));
  // The skull's border falls from the nape to under the chin.
  const double up = p.y() - y_of(head) + 0.6 * (p.z() - f.at(head).z());
  w.pass(neck, head, ramp(up, -0.062 * s, -0.022 * s));

  // An arm: down to the armpit only, what is below is the trunk.
  const double arm_height = ramp(p.y(), shoulder.y() - 0.125 * s, shoulder.y() - 0.055 * s);
  const HumanBone clavicle = left ? l_shoulder : r_shoulder;
  const HumanBone upper = left ? l_upper_arm : r_upper_arm;
  const HumanBone lower = left ? l_lower_arm : r_lower_arm;
  w.pass(chest, clavicle, arm_height * ramp(x, 0.045 * s, 0.135 * s));
  const double out = x - shoulder.x();
  w.pass(clavicle, upper, ramp(out, -0.060 * s, 0.050 * s));
  w.pass(chest, upper, arm_height * ramp(out, -0.060 * s, 0.050 * s));
  const double elbow = x - f.at(l_lower_arm).x();
  w.pass(upper, lower, ramp(elbow, -0.045 * s, 0.045 * s));
  // Half of the wrist's twist is spread over the forearm's end.
  const double wrist = x - f.at(l_hand).x();
  w.pass(lower, left ? l_hand : r_hand, ramp(wrist, -0.055 * s, 0.022 * s));
  if (f.skeleton.fingers && wrist > 0.0) {
    add_fingers(*f.skeleton.fingers, left ? Side::left : Side::right, p - f.at(left ? l_hand : r_hand), s, w);
  }

  const double leg = ramp(y_of(l_upper_leg) - p.y(), -0.035 * s, 0.085 * s);
  const double leftness = ramp(p.x(), -0.022 * s, 0.022 * s);
  const double hips_before = w[hips];
  w[hips] = hips_before * (1.0 - leg);
  w[l_upper_leg] = hips_before * leg * leftness;
  w[r_upper_leg] = hips_before * leg * (1.0 - leftness);
  const double shank = ramp(y_of(l_lower_leg) - p.y(), -0.055 * s, 0.055 * s);
  const double foot = ramp(y_of(l_foot) + 0.020 * s - p.y(), -0.025 * s, 0.025 * s);
  w.pass(l_upper_leg, l_lower_leg, shank);
  w.pass(r_upper_leg, r_lower_leg, shank);
  w.pass(l_lower_leg, l_foot, foot);
  w.pass(r_lower_leg, r_foot, foot);
  return w.strongest();
}

}  // namespace telemime
