// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/hand_noise.h"

#include <algorithm>
#include <numbers>

#include "telemime/tracker/one_euro.h"

namespace telemime {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
// How much two looks at the same synthetic hands differ in an angle: of a clear hand, and of one of which
// nothing is known, as of a middle joint anywhere between 0 and 110 degrees. docs/hands.md has what was
// measured.
constexpr double kClear = 2.2 * kDegree;
constexpr double kUnknown = 32.0 * kDegree;
constexpr double kCutoff = 0.6;  // Hz, of the noise of a hand that becomes clear

double variance_of(double visibility) {
  const double unknown = (1.0 - visibility) * kUnknown;
  return kClear * kClear + unknown * unknown;
}

}  // namespace

void HandNoise::observe(const HandMotion& measured, double step) {
  const bool seen = measured.visibility > 0.0;
  const bool appears = seen && !(last_ && last_->visibility > 0.0);
  // White noise makes changes that follow each other opposite: minus their product is its variance.
  Changes change;
  double white = 0.0;
  for (std::size_t f = 0; f < kFingerCount; ++f) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t angle = kFirstFingerAngle[f] + a;
      change[f][static_cast<Eigen::Index>(a)] =
          appears || !last_ ? 0.0 : measured.angles[angle] - last_->angles[angle];
    }
    white -= change[f].dot(change_[f]) / (3.0 * kFingerCount);
  }
  change_ = change;
  // At once where the visibility is bad, and for a while after that.
  if (seen) {
    const double learned = low_pass_share(kCutoff, step);
    const double now = variance_of(measured.visibility);
    by_visibility_ = std::max(now, by_visibility_ + learned * (now - by_visibility_));
    by_jitter_ += learned * (white - by_jitter_);
  }
  resting_ = seen ? 0.0 : resting_ + low_pass_share(kHandRestCutoff, step) * (1.0 - resting_);
  last_ = measured;
}

double HandNoise::variance() const {
  return last_ && last_->visibility > 0.0 ? std::max({kClear * kClear, by_visibility_, by_jitter_})
                                          : variance_of(resting_);
}

double HandNoise::ratio() const {
  return variance() / (kClear * kClear);
}

}  // namespace telemime
