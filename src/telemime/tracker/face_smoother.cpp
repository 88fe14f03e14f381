// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/face_smoother.h"

#include <algorithm>

#include "telemime/tracker/joint_rotations.h"
#include "telemime/tracker/smoother.h"

namespace telemime {
namespace {

constexpr OneEuroOptions kFast = {.minimum_cutoff = 3.0, .slope = 6.0, .speed_cutoff = 2.0};
constexpr OneEuroOptions kSteady = {.minimum_cutoff = 1.0, .slope = 0.6, .speed_cutoff = 1.0};
constexpr OneEuroOptions kHead = {.minimum_cutoff = 1.0, .slope = 3.0, .speed_cutoff = 1.0};
constexpr OneEuroOptions kGaze = {.minimum_cutoff = 1.5, .slope = 3.0, .speed_cutoff = 2.0};
// Noise of a face that is clearly seen (docs/face.md), from a filmed one with pupils 104 pixels apart.
constexpr double kClearGaze = 0.031;  // rad
constexpr double kClearExpression = 0.036;
constexpr double kNoise = 0.6;  // Hz, of the mean of the noise
// Variances of what faces do: of coefficients and angles that are equally likely in their ranges.
constexpr double kExpressionVariance = 1.0 / 12.0;
constexpr double kGazeVariance = 0.35 * 0.35;
constexpr double kToRest = 0.8;      // Hz, of a face that is not seen
constexpr double kConfidence = 1.0;  // Hz
constexpr double kForgotten = 0.01;  // confidence

/// Brows, cheeks, nose, and how narrow or wide the eyes are.
bool is_steady(std::size_t expression) {
  const std::string_view name = kExpressionNames[expression];
  return name.starts_with("brow") || name.starts_with("cheek") || name.starts_with("nose") ||
         name.starts_with("eyeSquint") || name.starts_with("eyeWide");
}

MeasuredNoise noise_of(double variance, double clear) {
  return {.variance = variance, .ratio = std::max(1.0, variance / (clear * clear))};
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
    variance_ = {};
    looks_ = 0.0;
    if (seen) {
      learn_noise(*measured, step);
    }
    return likely();
  }
  const double confidence = seen ? measured->confidence : 0.0;
  smooth_->confidence += low_pass_share(kConfidence, step) * (confidence - smooth_->confidence);
  if (seen) {
    learn_noise(*measured, step);
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
  return likely();
}

void FaceSmoother::learn_noise(const FaceMotion& measured, double step) {
  looks_ += 1.0;
  const double present = std::max(1.0 / looks_, low_pass_share(kNoise, step));
  const auto learn = [present](double noise, double& variance) {
    variance += present * (noise * noise - variance);
  };
  learn(measured.noise.gaze, variance_.gaze);
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    learn(measured.noise.expressions[i], variance_.expressions[i]);
  }
}

std::optional<FaceMotion> FaceSmoother::likely() const {
  std::optional<FaceMotion> face = smooth_;
  if (face) {
    face->noise = {};  // it has been taken into account
    const double scale = face->detail * face->detail;
    const auto share = [scale](double prior, double noise) {
      return noise > 0.0 ? scale * prior / (scale * prior + noise) : 1.0;
    };
    face->gaze *= share(kGazeVariance, variance_.gaze);
    for (std::size_t i = 0; i < kExpressionCount; ++i) {
      face->expressions[i] *= share(kExpressionVariance, variance_.expressions[i]);
    }
  }
  return face;
}

void FaceSmoother::follow(const FaceMotion& measured, double step) {
  // At first the mean of what was seen.
  const double least = 1.0 / looks_;
  const double head = head_speed_(turn_between(last_->head, measured.head), step, kHead);
  smooth_->head = smooth_->head.slerp(head, measured.head).normalized();
  const Eigen::Vector2d move = measured.gaze - last_->gaze;
  const double gaze =
      gaze_speed_({move.x(), move.y(), 0.0}, step, kGaze, noise_of(variance_.gaze, kClearGaze));
  smooth_->gaze += std::max(least, gaze) * (measured.gaze - smooth_->gaze);
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    const double change = measured.expressions[i] - last_->expressions[i];
    const double share = speed_[i]({change, 0.0, 0.0}, step, is_steady(i) ? kSteady : kFast,
                                   noise_of(variance_.expressions[i], kClearExpression));
    smooth_->expressions[i] += std::max(least, share) * (measured.expressions[i] - smooth_->expressions[i]);
  }
  smooth_->detail += low_pass_share(kConfidence, step) * (measured.detail - smooth_->detail);
  last_ = measured;
}

}  // namespace telemime
