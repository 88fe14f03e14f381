// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/tracked_pose.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "telemime/outputs/numbers.h"

namespace telemime::meeting {
namespace {

constexpr double kSure = 0.02;   // m
constexpr double kHardly = 0.2;  // m
constexpr double kSteps = 14.0;  // from 1 to 15
constexpr double kAxes = 3.0;
constexpr double kFarthest = 32767.0;  // mm

// The joint that each bone moves, from the hips to the right hand.
constexpr std::array<Joint, 13> kMovedJoint = {
    Joint::root,       Joint::neck,    Joint::neck,    Joint::head,   Joint::head_top,
    Joint::l_shoulder, Joint::l_elbow, Joint::l_wrist, Joint::l_hand, Joint::r_shoulder,
    Joint::r_elbow,    Joint::r_wrist, Joint::r_hand};

}  // namespace

std::uint8_t confidence_of(double deviation) {
  const double share = std::clamp((kHardly - deviation) / (kHardly - kSure), 0.0, 1.0);
  return static_cast<std::uint8_t>(1 + std::lround(kSteps * share));
}

PoseFrame pose_frame_of(const HumanoidMotion& motion, const std::optional<PoseSpread>& spread) {
  PoseFrame frame;
  frame.tracked = true;
  frame.mask = kTrackedBones;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double mm = motion.hips[static_cast<Eigen::Index>(axis)] * kMillimetresPerMetre;
    frame.hips[axis] = static_cast<std::int16_t>(std::lround(std::clamp(mm, -kFarthest, kFarthest)));
  }
  for (std::size_t bone = 0; bone < kMovedJoint.size(); ++bone) {
    frame.rotation[bone] = motion.rotation[bone];
    if (spread) {
      const Eigen::Matrix3d& covariance = spread->covariance[static_cast<std::size_t>(kMovedJoint[bone])];
      frame.confidence[bone] = confidence_of(std::sqrt(std::max(0.0, covariance.trace() / kAxes)));
    }
  }
  return frame;
}

}  // namespace telemime::meeting
