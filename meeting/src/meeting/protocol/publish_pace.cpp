// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/publish_pace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "telemime/outputs/numbers.h"

namespace telemime::meeting {
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
  if (!last_) {
    return std::numeric_limits<double>::lowest();
  }
  // A frame may go out one slot early. With frames as often as slots, the phase of the first would otherwise
  // stay: every frame would wait for its slot.
  return still(frame) ? slot_ + period(frame) : slot_;
}

void PublishPace::sent(const PoseFrame& frame, double now) {
  slot_ = last_ ? std::max(now, slot_ + period(frame)) : now;
  last_ = frame;
}

}  // namespace telemime::meeting
