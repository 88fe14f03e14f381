// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/publishing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "telemime/outputs/numbers.h"

namespace telemime::meeting {
namespace {

constexpr double kSure = 0.02;         // m, deviation of confidence 15
constexpr double kUnsure = 0.2;        // m, of confidence 1
constexpr double kConfidences = 14.0;  // steps from 1 to 15
constexpr double kFarthest = 32767.0;  // mm
constexpr double kSharedRate = 300.0;  // frames per second of all participants together
constexpr double kLeastRate = 5.0;
constexpr double kMostRate = 30.0;
constexpr double kStillAngle = 0.3 / kDegreesPerRadian;
constexpr double kStillHips = 3.0;  // mm
constexpr int kStillFingers = 2;    // degrees
constexpr int kStillGaze = 2;       // half degrees
constexpr int kStillWeight = 5;     // of 255
constexpr int kMostSkipped = 14;    // details

// The joint that each bone moves, from the hips to the right hand.
constexpr std::array<Joint, 13> kMovedJoint = {
    Joint::root,       Joint::neck,    Joint::neck,    Joint::head,   Joint::head_top,
    Joint::l_shoulder, Joint::l_elbow, Joint::l_wrist, Joint::l_hand, Joint::r_shoulder,
    Joint::r_elbow,    Joint::r_wrist, Joint::r_hand};

template <class Values>
bool are_near(const Values& a, const Values& b, int most) {
  return std::equal(a.begin(), a.end(), b.begin(), [most](int x, int y) { return std::abs(x - y) <= most; });
}

bool is_still(const PoseDetail& before, const PoseDetail& now) {
  if (before.fingers.has_value() != now.fingers.has_value() ||
      before.face.has_value() != now.face.has_value()) {
    return false;
  }
  return (!now.fingers || are_near(*before.fingers, *now.fingers, kStillFingers)) &&
         (!now.face || (are_near(before.face->gaze, now.face->gaze, kStillGaze) &&
                        are_near(before.face->arkit, now.face->arkit, kStillWeight) &&
                        are_near(before.face->vrm, now.face->vrm, kStillWeight)));
}

bool is_still(const PoseFrame& before, const PoseFrame& now) {
  if (before.tracked != now.tracked || before.mask != now.mask) {
    return false;
  }
  double squares = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = static_cast<double>(now.hips[axis]) - before.hips[axis];
    squares += step * step;
  }
  if (squares >= kStillHips * kStillHips) {
    return false;
  }
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    if (now.has(bone) && before.rotation[bone].angularDistance(now.rotation[bone]) > kStillAngle) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::uint8_t confidence_of(double deviation) {
  const double share = std::clamp((kUnsure - deviation) / (kUnsure - kSure), 0.0, 1.0);
  return static_cast<std::uint8_t>(1 + std::lround(kConfidences * share));
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
      frame.confidence[bone] = confidence_of(std::sqrt(std::max(0.0, covariance.trace() / 3.0)));
    }
  }
  return frame;
}

PoseDetail pose_detail_of(const HumanoidMotion& motion, const std::optional<FaceMotion>& face) {
  PoseDetail detail;
  if (motion.fingers) {
    detail.fingers = quantised(*motion.fingers);
  }
  if (face) {
    detail.face = quantised(*face);
  }
  return detail;
}

double publish_rate(std::size_t participants) {
  const auto count = static_cast<double>(std::max<std::size_t>(1, participants));
  return std::clamp(kSharedRate / count, kLeastRate, kMostRate);
}

bool is_still(const DetailedFrame& before, const DetailedFrame& now) {
  return is_still(before.pose, now.pose) && is_still(before.detail, now.detail);
}

double PublishPace::due(const DetailedFrame& frame) const {
  if (!last_) {
    return std::numeric_limits<double>::lowest();
  }
  // A moving frame may be one slot early. Otherwise, if frames come as often as slots, the phase of the first
  // one would persist and every frame would have to wait.
  return still(frame) ? slot_ + period(frame) : slot_;
}

void PublishPace::sent(const DetailedFrame& frame, double now) {
  slot_ = last_ ? std::max(now, slot_ + period(frame)) : now;
  last_ = frame;
}

bool DetailPace::take(const PoseDetail& detail) {
  const bool same = detail.fingers == last_.fingers && detail.face == last_.face;
  if (same && (!taken_ || skipped_ < kMostSkipped)) {
    ++skipped_;
    return false;
  }
  last_ = detail;
  taken_ = true;
  skipped_ = 0;
  return true;
}

}  // namespace telemime::meeting
