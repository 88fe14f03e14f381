// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/clean_frames.h"

#include <algorithm>
#include <cmath>

namespace telemime {
namespace {

bool pose_is_finite(const MotionFrame& frame) {
  return frame.pose.root.allFinite() &&
         std::all_of(frame.pose.angles.begin(), frame.pose.angles.end(),
                     [](double a) { return std::isfinite(a); }) &&
         std::all_of(frame.joints.at.begin(), frame.joints.at.end(),
                     [](const Eigen::Vector3d& p) { return p.allFinite(); });
}

bool spread_is_finite(const PoseSpread& spread) {
  return std::isfinite(spread.second_mode) && std::isfinite(spread.effective_particles) &&
         std::all_of(spread.covariance.begin(), spread.covariance.end(),
                     [](const Eigen::Matrix3d& c) { return c.allFinite(); });
}

bool face_is_finite(const FaceMotion& face) {
  return std::isfinite(face.confidence) && face.head.coeffs().allFinite() && face.gaze.allFinite() &&
         std::all_of(face.expressions.begin(), face.expressions.end(),
                     [](double value) { return std::isfinite(value); });
}

bool hands_are_finite(const HandMotions& hands) {
  return std::all_of(hands.begin(), hands.end(), [](const HandMotion& hand) {
    const auto finite = [](double a) { return std::isfinite(a); };
    return finite(hand.visibility) && finite(hand.spread) && finite(hand.wrist.twisting) &&
           finite(hand.wrist.pivot) && finite(hand.wrist.flexion) &&
           std::all_of(hand.angles.begin(), hand.angles.end(), finite) &&
           std::all_of(hand.joints.begin(), hand.joints.end(),
                       [](const Eigen::Vector3d& p) { return p.allFinite(); });
  });
}

double finite_or(double value, double otherwise) {
  return std::isfinite(value) ? value : otherwise;
}

}  // namespace

// Eigen leaves new vectors uninitialised.
MotionFrame CleanFrames::blank() {
  MotionFrame frame;
  frame.joints.at.fill(frame.pose.root);
  frame.pixels.fill(Eigen::Vector2d::Zero());
  return frame;
}

MotionFrame CleanFrames::operator()(const MotionFrame& frame) {
  MotionFrame clean = frame;
  const bool finite = pose_is_finite(frame);
  clean.state = finite ? frame.state : TrackState::lost;
  tracked_ = tracked_ || clean.state == TrackState::tracking;
  if (!finite || (tracked_ && clean.state == TrackState::lost)) {
    clean.pose = last_.pose;
    clean.joints = last_.joints;
    clean.pixels = last_.pixels;
    clean.hands = last_.hands;
  }
  if (clean.hands && !hands_are_finite(*clean.hands)) {
    clean.hands = last_.hands;
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!clean.pixels[j].allFinite()) {
      clean.pixels[j] = last_.pixels[j];
    }
  }
  clean.time = finite_or(frame.time, last_.time);
  clean.region_score = finite_or(frame.region_score, last_.region_score);
  clean.contour_score = finite_or(frame.contour_score, last_.contour_score);
  if (clean.spread && !spread_is_finite(*clean.spread)) {
    clean.spread.reset();
  }
  if (clean.face && !face_is_finite(*clean.face)) {
    clean.face.reset();
  }
  for (auto& [stage, ms] : clean.stage_ms) {
    ms = finite_or(ms, 0.0);
  }
  last_ = clean;
  return clean;
}

}  // namespace telemime
