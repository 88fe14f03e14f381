// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/face_smoother.h"

#include "telemime/tracker/joint_rotations.h"
#include "telemime/tracker/smoother.h"

namespace telemime {
namespace {

constexpr OneEuroOptions kFast = {.minimum_cutoff = 3.0, .slope = 6.0, .speed_cutoff = 2.0};
constexpr OneEuroOptions kSteady = {.minimum_cutoff = 1.0, .slope = 0.6, .speed_cutoff = 1.0};
constexpr OneEuroOptions kHead = {.minimum_cutoff = 1.0, .slope = 3.0, .speed_cutoff = 1.0};
constexpr OneEuroOptions kGaze = {.minimum_cutoff = 1.5, .slope = 3.0, .speed_cutoff = 2.0};
constexpr double kToRest = 0.8;      // Hz, of a face that is not seen
constexpr double kConfidence = 1.0;  // Hz
constexpr double kForgotten = 0.01;  // confidence

/// Brows, cheeks, nose, and how narrow or wide the eyes are.
bool is_steady(std::size_t expression) {
  const std::string_view name = kExpressionNames[expression];
  return name.starts_with("brow") || name.starts_with("cheek") || name.starts_with("nose") ||
         name.starts_with("eyeSquint") || name.starts_with("eyeWide");
}

}  // namespace

std::optional<FaceMotion> FaceSmoother::operator()(const std::optional<FaceMotion>& measured, double time) {
  const double step = time_ ? time - *time_ : 0.0;
  time_ = time;
  const bool seen = measured && measured->confidence > 0.0;
  const bool begins = !smooth_ || !(step > 0.0 && step <= kLongestGap);
  if (begins || !seen || !last_) {
    // Nothing is known of the speed of a face that appears.
    last_ = seen ? measured : std::nullopt;
    speed_.fill({});
    head_speed_.reset();
    gaze_speed_.reset();
  }
  if (begins) {
    smooth_ = last_;
    return smooth_;
  }
  const double confidence = seen ? measured->confidence : 0.0;
  smooth_->confidence += low_pass_share(kConfidence, step) * (confidence - smooth_->confidence);
  if (seen) {
    follow(*measured, step);
  } else {
    const double rest = low_pass_share(kToRest, step);
    smooth_->gaze -= rest * smooth_->gaze;
    for (double& value : smooth_->expressions) {
      value -= rest * value;
    }
    if (smooth_->confidence < kForgotten) {
      smooth_.reset();
    }
  }
  return smooth_;
}

void FaceSmoother::follow(const FaceMotion& measured, double step) {
  const double head = head_speed_(turn_between(last_->head, measured.head), step, kHead);
  smooth_->head = smooth_->head.slerp(head, measured.head).normalized();
  const Eigen::Vector2d move = measured.gaze - last_->gaze;
  smooth_->gaze += gaze_speed_({move.x(), move.y(), 0.0}, step, kGaze) * (measured.gaze - smooth_->gaze);
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    const double change = measured.expressions[i] - last_->expressions[i];
    const double share = speed_[i]({change, 0.0, 0.0}, step, is_steady(i) ? kSteady : kFast);
    smooth_->expressions[i] += share * (measured.expressions[i] - smooth_->expressions[i]);
  }
  last_ = measured;
}

}  // namespace telemime
