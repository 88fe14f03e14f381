// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/head_errors.h"

#include <array>
#include <cmath>

#include "telemime/evaluation/error_means.h"

namespace telemime {

Eigen::Vector3d head_error(const Eigen::Quaterniond& estimate, const Eigen::Quaterniond& truth) {
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(truth.conjugate() * estimate));
  return turn.angle() * turn.axis();
}

std::optional<HeadReport> measure_heads(const std::vector<MotionFrame>& frames, const Truth& truth) {
  constexpr double kSeen = 0.5;
  HeadReport report;
  std::vector<double> angles;
  Mean mean;
  std::array<Mean, 3> parts;
  bool faces = false;
  for (const MotionFrame& frame : frames) {
    const auto t = static_cast<std::size_t>(frame.frame);
    if (frame.state != TrackState::tracking || t >= truth.heads.size() || !truth.is_scored(t) ||
        !truth.heads[t]) {
      continue;
    }
    ++report.heads;
    faces = faces || frame.face;
    if (frame.face && frame.face->confidence >= kSeen) {
      const Eigen::Vector3d error = head_error(frame.face->head, *truth.heads[t]);
      angles.push_back(error.norm());
      mean.add(error.norm());
      for (std::size_t axis = 0; axis < parts.size(); ++axis) {
        parts[axis].add(std::abs(error[static_cast<Eigen::Index>(axis)]));
      }
    }
  }
  if (!faces) {
    return std::nullopt;
  }
  report.seen = static_cast<double>(angles.size()) / static_cast<double>(report.heads);
  report.angle = mean.value();
  report.angle_p95 = quantile(angles, 0.95);
  report.pitch = parts[0].value();
  report.yaw = parts[1].value();
  report.roll = parts[2].value();
  return report;
}

}  // namespace telemime
