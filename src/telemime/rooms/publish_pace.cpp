// SPDX-License-Identifier: Apache-2.0
#include "telemime/rooms/publish_pace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

constexpr double kFramesForEach = 300.0;  // a second, of all participants together
constexpr double kLeastRate = 5.0;
constexpr double kMostRate = 30.0;
constexpr double kStillAngle = 0.3 / kDegreesPerRadian;
constexpr double kStillHips = 3.0;  // mm

}  // namespace

double publish_rate(std::size_t participants) {
  const auto count = static_cast<double>(std::max<std::size_t>(1, participants));
  return std::clamp(kFramesForEach / count, kLeastRate, kMostRate);
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

double PublishPace::period(const PoseFrame& frame) const {
  return 1.0 / (still(frame) ? kStillRate : rate_);
}

double PublishPace::due(const PoseFrame& frame) const {
  return last_ ? slot_ + period(frame) : std::numeric_limits<double>::lowest();
}

void PublishPace::sent(const PoseFrame& frame, double now) {
  // The slots are evenly spaced, so that frames that come a little late do not lower the rate.
  const double slot = due(frame);
  slot_ = last_ && now - slot < period(frame) ? slot : now;
  last_ = frame;
}

}  // namespace telemime
