// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/error_means.h"

#include <algorithm>
#include <cmath>

namespace telemime {

std::optional<double> quantile(std::vector<double> values, double q) {
  if (values.empty()) {
    return std::nullopt;
  }
  std::sort(values.begin(), values.end());
  const double place = q * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(std::floor(place));
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (place - static_cast<double>(low)) * (values[high] - values[low]);
}

void ErrorMeans::add(const JointError& error) {
  camera.add(error.camera.norm());
  if (error.aligned) {
    aligned.add(error.aligned->norm());
    image_plane.add(error.aligned->head<2>().norm());
    depth.add(std::abs(error.aligned->z()));
  }
  if (error.fitted) {
    fitted.add(error.fitted->norm());
  }
  pixels.add(error.pixels);
  pixels_at_depth.add(error.pixels_at_depth);
}

void ErrorMeans::add(const MeanErrors& errors) {
  camera.add(errors.camera);
  aligned.add(errors.aligned);
  image_plane.add(errors.image_plane);
  depth.add(errors.depth);
  fitted.add(errors.fitted);
  pixels.add(errors.pixels);
  pixels_at_depth.add(errors.pixels_at_depth);
}

MeanErrors ErrorMeans::value() const {
  return {camera.value(), aligned.value(), image_plane.value(),    depth.value(),
          fitted.value(), pixels.value(),  pixels_at_depth.value()};
}

void ErrorCollector::add(const FrameErrors& errors) {
  ++frames_;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (errors[j]) {
      by_joint_[j].add(*errors[j]);
    }
  }
  ErrorMeans frame;
  for (const Joint joint : kScoredJoints) {
    if (const auto& error = errors[static_cast<std::size_t>(joint)]) {
      frame.add(*error);
    }
  }
  const MeanErrors means = frame.value();
  scored_.add(means);
  if (means.aligned) {
    aligned_.push_back(*means.aligned);
  }
}

ErrorReport ErrorCollector::report() const {
  ErrorReport report;
  report.frames = frames_;
  report.scored = scored_.value();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    report.by_joint[j] = by_joint_[j].value();
  }
  report.aligned_median = quantile(aligned_, 0.5);
  report.aligned_p95 = quantile(aligned_, 0.95);
  return report;
}

}  // namespace telemime
