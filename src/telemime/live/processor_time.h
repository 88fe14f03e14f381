// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// The processor time that this process has used, all threads together, s.
double processor_seconds();

/// Cores in use, of readings taken now and then; the last second counts most.
class CoresInUse {
 public:
  /// `now`: of any clock that never goes back, s; `used`: processor_seconds() at that time.
  CoresInUse(double now, double used) : time_(now), used_(used) {}
  void read(double now, double used) {
    if (now > time_) {
      value_ = 0.5 * value_ + 0.5 * (used - used_) / (now - time_);
    }
    time_ = now;
    used_ = used;
  }
  double value() const { return value_; }

 private:
  double time_;
  double used_;
  double value_ = 0.0;
};

}  // namespace telemime
