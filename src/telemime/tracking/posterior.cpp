// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/posterior.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "telemime/body/arm_parts.h"
#include "telemime/core/square.h"
#include "telemime/core/visible_line.h"

namespace telemime {
namespace {

using ArmPoints = Eigen::Matrix<double, 3, 4>;

ArmPoints arm_points(const Body& body, const Pose& pose) {
  const JointPositions j = forward_kinematics(body, pose).joints;
  ArmPoints points;
  points << j[Joint::l_elbow], j[Joint::l_wrist], j[Joint::r_elbow], j[Joint::r_wrist];
  return points;
}

// Largest standard deviation of a bone's end outside the image, as a share of the bone's length.
constexpr double kUnseen = 0.5;
// The same of a wrist whose hand is outside the image: the forearm may continue there.
constexpr double kCut = 0.25;
// Power of F (over that of a pose that fits well) with which deviations grow. With landmarks: chosen on
// two filmed people, whose F is 2.5 and 6 times larger and whose deviations are 1.7 and 2.7 times larger.
constexpr double kPoor = 2.0;
constexpr double kPoorSeen = 0.5;
// Without the boundary between sleeve and skin an arm of one colour shows its elbow by its outline alone.
constexpr double kCovered = 2.0;

constexpr double kNearestSeen = 0.05;  // m: what is nearer to the camera cannot be seen

bool is_in_image(const Camera& camera, const Eigen::Vector3d& point) {
  if (point.z() < kNearestSeen) {
    return false;
  }
  const Eigen::Vector2d p = camera.project(point);
  return p.x() > -0.5 && p.y() > -0.5 && p.x() < camera.width - 0.5 && p.y() < camera.height - 0.5;
}

// The covariance of a bone's end from that of its start. `along` is the part of it along the viewing ray that
// comes from bones (m); it grows with the bone's own. Depth errors along an arm have one cause - lengths that
// are wrong together - so they add up as they are, not by their squares.
Eigen::Matrix3d end_of_bone(const Camera& camera, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                            const SpreadModel& model, const Eigen::Matrix3d& start, double& along) {
  const double length = (to - from).norm();
  const Eigen::Vector3d ray = from.normalized();
  if (!is_in_image(camera, to)) {
    // What is seen of the bone shows its direction in the image, the longer the better, but not its depth.
    const double seen = std::min(from.z(), to.z()) < kNearestSeen
                            ? 0.0
                            : share_in_image(camera, camera.project(from), camera.project(to));
    const double unseen = kUnseen * length;
    const double across = model.across < kUnseen * seen ? model.across * length / seen : unseen;
    return start + across * across * (Eigen::Matrix3d::Identity() - ray * ray.transpose()) +
           unseen * unseen * ray * ray.transpose();
  }
  const double sine = length > 0.0 ? (to - from).dot(ray) / length : 0.0;
  const double across = model.across * length;
  const double before = along;
  along += model.seen * length / std::sqrt(sine * sine + 2.0 * model.seen);
  return start + across * across * (Eigen::Matrix3d::Identity() - ray * ray.transpose()) +
         (along * along - before * before) * ray * ray.transpose();
}

}  // namespace

std::vector<Mode> find_modes(const Body& body, std::span<const Particle> particles, double radius,
                             std::size_t most) {
  // A particle with less weight does not form a mode.
  constexpr double kLeast = 1e-9;
  std::vector<std::size_t> order(particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return particles[a].weight > particles[b].weight; });
  // Each particle joins the first mode within the radius, or forms a new one.
  std::vector<Mode> modes;
  std::vector<ArmPoints> places;
  for (const std::size_t i : order) {
    if (particles[i].weight < kLeast && !modes.empty()) {
      break;
    }
    const ArmPoints here = arm_points(body, particles[i].pose);
    bool taken = false;
    for (std::size_t m = 0; m < modes.size() && !taken; ++m) {
      taken = (here - places[m]).colwise().norm().maxCoeff() <= radius;
      if (taken) {
        modes[m].weight += particles[i].weight;
        const double likeliest = particles[modes[m].likeliest].log_likelihood;
        modes[m].likeliest = particles[i].log_likelihood > likeliest ? i : modes[m].likeliest;
      }
    }
    if (!taken && modes.size() < most) {
      modes.push_back({i, i, particles[i].weight});
      places.push_back(here);
    }
  }
  return modes;
}

std::array<Eigen::Matrix3d, kJointCount> model_covariance(const SpreadContext& context, const Pose& estimate,
                                                          const SpreadModel& model) {
  // Trunk: the same standard deviation for each joint.
  const JointPositions joints = forward_kinematics(context.body, estimate).joints;
  const Eigen::Vector3d middle = mid_shoulders(joints);
  std::array<Eigen::Matrix3d, kJointCount> covariance;
  covariance.fill(Eigen::Matrix3d::Identity() * (model.trunk * model.trunk));
  const auto at = [&](Joint j) -> Eigen::Matrix3d& { return covariance[static_cast<std::size_t>(j)]; };
  constexpr std::array<std::pair<Joint, Joint>, 6> kBones = {{{Joint::l_shoulder, Joint::l_elbow},
                                                              {Joint::r_shoulder, Joint::r_elbow},
                                                              {Joint::l_elbow, Joint::l_wrist},
                                                              {Joint::r_elbow, Joint::r_wrist},
                                                              {Joint::l_wrist, Joint::l_hand},
                                                              {Joint::r_wrist, Joint::r_hand}}};
  // Arms: from the shoulder outward, each bone adds to the covariance of its start.
  SpreadModel arms = model;
  std::array<double, kJointCount> along{};
  constexpr double kToTheWrist = 1.5;
  if (context.body.shape.sleeve > kToTheWrist) {
    arms.across *= kCovered;
    arms.seen *= kCovered;
  }
  for (const auto& [from, to] : kBones) {
    double& along_arm = along[static_cast<std::size_t>(to)];
    along_arm = along[static_cast<std::size_t>(from)];
    at(to) = end_of_bone(context.camera, joints[from], joints[to], arms, at(from), along_arm);
    if (to == Joint::l_wrist || to == Joint::r_wrist) {
      const Eigen::Vector3d forearm = (joints[to] - joints[from]).normalized();
      at(to) += square(model.slide) * forearm * forearm.transpose();
    }
  }
  // Lean of trunk and head, in proportion to the distance from the shoulders.
  for (const Joint joint : {Joint::root, Joint::neck, Joint::head, Joint::head_top}) {
    at(joint) += Eigen::Matrix3d::Identity() * (square(model.lean) * (joints[joint] - middle).squaredNorm());
  }
  // Wrists whose hand is outside the image.
  for (const Side side : {Side::left, Side::right}) {
    const ArmParts& arm = arm_parts(side);
    if (is_in_image(context.camera, joints[arm.wrist]) && !is_in_image(context.camera, joints[arm.knuckle])) {
      at(arm.wrist) += Eigen::Matrix3d::Identity() *
                       square(kCut * context.body.forearm_length[static_cast<std::size_t>(side)]);
    }
  }
  // Larger for a pose that fits badly, and along the line from the shoulders for an unknown size.
  const double worse =
      std::pow(std::max(1.0, context.region / model.residual), context.landmarks ? kPoorSeen : kPoor);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    covariance[j] *= worse * worse;
    const Eigen::Vector3d reach = context.size * (joints.at[j] - middle);
    covariance[j] += reach * reach.transpose();
  }
  return covariance;
}

PoseSpread spread_of(const SpreadContext& context, std::span<const Particle> particles, const Pose& estimate,
                     const SpreadModel& model) {
  // Lighter particles do not change the digits that are written.
  constexpr double kLeast = 1e-6;
  // Covariance of the model plus that of the particles, relative to the middle of the shoulders.
  const Body& body = context.body;
  PoseSpread spread;
  spread.covariance = model_covariance(context, estimate, model);
  const JointPositions own = forward_kinematics(body, estimate).joints;
  const Eigen::Vector3d middle = mid_shoulders(own);
  for (const Particle& particle : particles) {
    if (particle.weight < kLeast) {
      continue;
    }
    const JointPositions joints = forward_kinematics(body, particle.pose).joints;
    const Eigen::Vector3d shift = mid_shoulders(joints) - middle;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Eigen::Vector3d way = joints.at[j] - shift - own.at[j];
      spread.covariance[j] += particle.weight * way * way.transpose();
    }
  }
  // Weight of the second mode, and how many particles carry the estimate.
  constexpr double kModeRadius = 0.1;  // m, of an elbow or wrist
  const std::vector<Mode> modes = find_modes(body, particles, kModeRadius, 2);
  spread.second_mode = modes.size() > 1 ? modes[1].weight : 0.0;
  spread.effective_particles = effective_sample_size(particles);
  return spread;
}

PoseSpread about(PoseSpread spread, const JointPositions& from, const JointPositions& to) {
  const Eigen::Vector3d shift = mid_shoulders(to) - mid_shoulders(from);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Eigen::Vector3d way = to.at[j] - from.at[j] - shift;
    spread.covariance[j] += way * way.transpose();
  }
  return spread;
}

}  // namespace telemime
