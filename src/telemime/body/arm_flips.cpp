// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/arm_flips.h"

#include <cmath>
#include <optional>
#include <utility>

#include "telemime/body/arm_parts.h"
#include "telemime/body/interpenetration.h"

namespace telemime {
namespace {

constexpr double kNearest = 0.1;  // m before the camera
// Of the angles: 1e-6 rad move a wrist by less than a micrometre.
constexpr double kSlack = 1e-6;

// Where the ray meets the sphere: the nearer or the farther point. Nothing when it passes by.
std::optional<Eigen::Vector3d> on_sphere(const Eigen::Vector3d& ray, const Eigen::Vector3d& centre,
                                         double radius, bool farther) {
  const double along = ray.dot(centre);
  const double square = radius * radius - (centre - along * ray).squaredNorm();
  if (square < 0.0) {
    return std::nullopt;
  }
  const double half = std::sqrt(square);
  return ray * (along + (farther ? half : -half));
}

// The elbow on its ray for an upper arm whose shoulder moves with it.
std::optional<Eigen::Vector3d> elbow_on_ray(const Body& body, const Eigen::Isometry3d& camera_from_chest,
                                            Side side, const Eigen::Vector3d& ray,
                                            const Eigen::Vector3d& shoulder, bool farther) {
  constexpr int kSteps = 60;
  const double length = body.upper_arm_length[static_cast<std::size_t>(side)];
  Eigen::Vector3d centre = shoulder;
  std::optional<Eigen::Vector3d> elbow;
  for (int step = 0; step < kSteps; ++step) {
    elbow = on_sphere(ray, centre, length, farther);
    if (!elbow) {
      return std::nullopt;
    }
    const Eigen::Vector3d direction = camera_from_chest.linear().transpose() * (*elbow - centre).normalized();
    const Eigen::Vector3d next = camera_from_chest * shoulder_in_chest(body, side, direction);
    const double change = (next - centre).norm();
    centre = next;
    if (change < 1e-9) {
      return elbow;
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<Pose> arm_flips(const Body& body, const Pose& pose, Side side, const JointLimits& limits) {
  const ArmParts& arm = arm_parts(side);
  const auto i = static_cast<std::size_t>(side);
  const Kinematics k = forward_kinematics(body, pose);
  const Eigen::Vector3d& shoulder = k.joints[arm.shoulder];
  const Eigen::Vector3d& elbow = k.joints[arm.elbow];
  const Eigen::Vector3d& wrist = k.joints[arm.wrist];
  const Eigen::Vector3d elbow_ray = elbow.normalized();
  const Eigen::Vector3d wrist_ray = wrist.normalized();
  const bool elbow_far = elbow_ray.dot(elbow - shoulder) > 0.0;
  const bool wrist_far = wrist_ray.dot(wrist - elbow) > 0.0;
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> places;
  const auto add = [&](const Eigen::Vector3d& e, bool farther) {
    if (const auto w = on_sphere(wrist_ray, e, body.forearm_length[i], farther)) {
      places.emplace_back(e, *w);
    }
  };
  add(elbow, !wrist_far);
  if (const auto other = elbow_on_ray(body, k[Segment::chest], side, elbow_ray, shoulder, !elbow_far)) {
    add(*other, false);
    add(*other, true);
  }
  std::vector<Pose> flips;
  for (const auto& [e, w] : places) {
    Pose flipped = pose;
    set_arm_angles(flipped, side, arm_through(body, pose, side, e, w, limits));
    if (e.z() > kNearest && w.z() > kNearest && limits.contains(flipped, kSlack) &&
        interpenetration(body, forward_kinematics(body, flipped)) < kInvalidInterpenetration) {
      flips.push_back(limits.clamp(flipped));
    }
  }
  return flips;
}

std::vector<Pose> kinematic_flips(const Body& body, const Pose& pose, const JointLimits& limits) {
  std::vector<Pose> lefts = arm_flips(body, pose, Side::left, limits);
  lefts.insert(lefts.begin(), pose);
  std::vector<Pose> flips;
  for (std::size_t l = 0; l < lefts.size(); ++l) {
    if (l > 0) {
      flips.push_back(lefts[l]);
    }
    const std::vector<Pose> rights = arm_flips(body, lefts[l], Side::right, limits);
    flips.insert(flips.end(), rights.begin(), rights.end());
  }
  return flips;
}

}  // namespace telemime
