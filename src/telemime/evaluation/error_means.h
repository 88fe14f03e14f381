// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "telemime/evaluation/evaluate.h"

namespace telemime {

/// Running mean.
class Mean {
 public:
  void add(double value) {
    sum_ += value;
    ++count_;
  }
  void add(const std::optional<double>& value) {
    if (value) {
      add(*value);
    }
  }
  /// Nothing before the first value.
  std::optional<double> value() const {
    return count_ == 0 ? std::nullopt : std::optional<double>(sum_ / static_cast<double>(count_));
  }

 private:
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

/// The q-quantile, q in [0, 1], linear between the sorted values (type 7 of Hyndman & Fan 1996). Nothing of
/// an empty list.
std::optional<double> quantile(std::vector<double> values, double q);

/// One mean for each member of MeanErrors.
struct ErrorMeans {
  Mean camera, aligned, image_plane, depth, fitted, pixels, pixels_at_depth;
  void add(const JointError& error);
  void add(const MeanErrors& errors);
  MeanErrors value() const;
};

/// Gathers the errors of frames.
class ErrorCollector {
 public:
  void add(const FrameErrors& errors);
  ErrorReport report() const;

 private:
  std::size_t frames_ = 0;
  ErrorMeans scored_;
  std::array<ErrorMeans, kJointCount> by_joint_;
  std::vector<double> aligned_;
};

}  // namespace telemime
