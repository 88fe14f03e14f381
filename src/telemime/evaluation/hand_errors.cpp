// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/hand_errors.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "telemime/evaluation/error_means.h"

namespace telemime {
namespace {

constexpr std::array<std::size_t, 5> kPalm = {0, 5, 9, 13, 17};

bool is_in_image(const HandPoints& hand, const Camera& camera) {
  return std::all_of(hand.begin(), hand.end(), [&](const Eigen::Vector3d& p) {
    if (!(p.z() > 0.0)) {
      return false;
    }
    const Eigen::Vector2d pixel = camera.project(p);
    return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < camera.width && pixel.y() < camera.height;
  });
}

}  // namespace

double palm_aligned_error(const HandPoints& estimate, const HandPoints& truth) {
  Eigen::Matrix<double, 3, 5> from;
  Eigen::Matrix<double, 3, 5> to;
  for (std::size_t i = 0; i < kPalm.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = estimate[kPalm[i]];
    to.col(static_cast<Eigen::Index>(i)) = truth[kPalm[i]];
  }
  const Eigen::Isometry3d motion(Eigen::umeyama(from, to, false));
  Mean error;
  for (std::size_t j = 1; j < kHandJointCount; ++j) {
    if (std::find(kPalm.begin(), kPalm.end(), j) == kPalm.end()) {
      error.add((motion * estimate[j] - truth[j]).norm());
    }
  }
  return *error.value();
}

std::optional<HandReport> measure_hands(const std::vector<MotionFrame>& frames, const Truth& truth,
                                        double scale) {
  constexpr double kSeen = 0.5;
  HandReport report;
  std::vector<double> errors;
  Mean mean;
  for (const MotionFrame& frame : frames) {
    const auto t = static_cast<std::size_t>(frame.frame);
    if (!frame.hands || frame.state != TrackState::tracking || t >= truth.hands.size() ||
        !truth.is_scored(t)) {
      continue;
    }
    for (std::size_t side = 0; side < 2; ++side) {
      const std::optional<HandPoints>& known = truth.hands[t][side];
      if (!known || !is_in_image(*known, truth.camera)) {
        continue;
      }
      ++report.hands;
      const HandMotion& hand = (*frame.hands)[side];
      if (hand.visibility >= kSeen) {
        HandPoints scaled = hand.joints;
        for (Eigen::Vector3d& point : scaled) {
          point *= scale;
        }
        errors.push_back(palm_aligned_error(scaled, *known));
        mean.add(errors.back());
      }
    }
  }
  if (report.hands == 0) {
    return std::nullopt;
  }
  report.seen = static_cast<double>(errors.size()) / static_cast<double>(report.hands);
  report.palm_aligned = mean.value();
  report.palm_aligned_p95 = quantile(errors, 0.95);
  return report;
}

}  // namespace telemime
