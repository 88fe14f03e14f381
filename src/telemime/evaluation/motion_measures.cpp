// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/motion_measures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "telemime/evaluation/error_means.h"
#include "telemime/evaluation/frame_errors.h"

namespace telemime {
namespace {

constexpr double kLeastMotion = 0.005;  // m
constexpr std::size_t kFewestFrames = 10;

/// The joint of a frame, or null.
const Eigen::Vector3d* joint_at(const JointTrack& track, std::size_t frame, Joint joint) {
  if (frame >= track.size() || !track[frame]) {
    return nullptr;
  }
  const auto& place = (*track[frame])[static_cast<std::size_t>(joint)];
  return place ? &*place : nullptr;
}

/// Sums over the pairs of one coordinate, from which its covariance comes.
struct PairSums {
  double n = 0.0;
  Eigen::Array3d a = Eigen::Array3d::Zero();
  Eigen::Array3d b = Eigen::Array3d::Zero();
  Eigen::Array3d aa = Eigen::Array3d::Zero();
  Eigen::Array3d bb = Eigen::Array3d::Zero();
  Eigen::Array3d ab = Eigen::Array3d::Zero();

  void add(const Eigen::Array3d& p, const Eigen::Array3d& q) {
    n += 1.0;
    a += p;
    b += q;
    aa += p * p;
    bb += q * q;
    ab += p * q;
  }
};

struct Correlation {
  double value = 0.0;
  double truth_deviation = 0.0;  ///< m, root mean square over the coordinates
};

/// Correlation of estimate(t + shift) with truth(t); nothing with too few pairs or no motion at all.
std::optional<Correlation> correlation_at(const JointTrack& estimate, const JointTrack& truth, int shift) {
  double covariance = 0.0;
  double estimate_variance = 0.0;
  double truth_variance = 0.0;
  int coordinates = 0;
  for (const Joint joint : kScoredJoints) {
    PairSums sums;
    for (std::size_t t = 0; t < truth.size(); ++t) {
      const std::ptrdiff_t other = static_cast<std::ptrdiff_t>(t) + shift;
      const auto* const q = joint_at(truth, t, joint);
      const auto* const p = other < 0 ? nullptr : joint_at(estimate, static_cast<std::size_t>(other), joint);
      if (p != nullptr && q != nullptr) {
        sums.add(p->array(), q->array());
      }
    }
    if (sums.n < static_cast<double>(kFewestFrames)) {
      continue;
    }
    covariance += (sums.ab / sums.n - sums.a * sums.b / (sums.n * sums.n)).sum();
    estimate_variance += (sums.aa / sums.n - (sums.a / sums.n).square()).sum();
    truth_variance += (sums.bb / sums.n - (sums.b / sums.n).square()).sum();
    coordinates += 3;
  }
  if (coordinates == 0 || !(estimate_variance > 0.0) || !(truth_variance > 0.0)) {
    return std::nullopt;
  }
  return Correlation{covariance / std::sqrt(estimate_variance * truth_variance),
                     std::sqrt(truth_variance / coordinates)};
}

}  // namespace

std::optional<double> wrist_jitter(const JointTrack& track) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const Joint wrist : {Joint::l_wrist, Joint::r_wrist}) {
    for (std::size_t t = 1; t + 1 < track.size(); ++t) {
      const auto* const before = joint_at(track, t - 1, wrist);
      const auto* const here = joint_at(track, t, wrist);
      const auto* const after = joint_at(track, t + 1, wrist);
      if (before != nullptr && here != nullptr && after != nullptr) {
        sum += (*after - 2.0 * *here + *before).norm();
        ++count;
      }
    }
  }
  if (count == 0) {
    return std::nullopt;
  }
  return sum / static_cast<double>(count);
}

std::optional<Lag> lag_behind(const JointTrack& estimate, const JointTrack& truth, int longest) {
  const auto still = correlation_at(estimate, truth, 0);
  if (!still || still->truth_deviation < kLeastMotion) {
    return std::nullopt;
  }
  std::vector<std::optional<Correlation>> values;
  for (int shift = -longest; shift <= longest; ++shift) {
    values.push_back(correlation_at(estimate, truth, shift));
  }
  const auto peak = std::max_element(values.begin(), values.end(), [](const auto& a, const auto& b) {
    return (a ? a->value : -2.0) < (b ? b->value : -2.0);
  });
  if (peak == values.begin() || peak + 1 == values.end() || !*(peak - 1) || !*(peak + 1)) {
    return std::nullopt;
  }
  const double before = (*(peak - 1))->value;
  const double here = (*peak)->value;
  const double after = (*(peak + 1))->value;
  const double curvature = before - 2.0 * here + after;
  const double offset = curvature < 0.0 ? 0.5 * (before - after) / curvature : 0.0;
  return Lag{static_cast<double>(peak - values.begin()) - longest + offset, here};
}

std::optional<TurnReport> measure_turn(const JointTrack& estimate, const JointTrack& truth) {
  const double kTurned = std::sin(std::numbers::pi / 12.0);
  TurnReport report;
  Mean error, error_turned;
  for (std::size_t t = 0; t < truth.size(); ++t) {
    const auto direction = [t](const JointTrack& track) -> std::optional<double> {
      const auto* const l = joint_at(track, t, Joint::l_shoulder);
      const auto* const r = joint_at(track, t, Joint::r_shoulder);
      return l && r ? std::optional(std::atan2(l->z() - r->z(), l->x() - r->x())) : std::nullopt;
    };
    const std::optional<double> found = direction(estimate);
    const std::optional<double> exact = direction(truth);
    if (!found || !exact) {
      continue;
    }
    const double difference = std::abs(std::remainder(*found - *exact, 2.0 * std::numbers::pi));
    ++report.frames;
    error.add(difference);
    if (std::abs(std::sin(*exact)) >= kTurned) {
      ++report.turned;
      error_turned.add(difference);
      report.wrong_way += std::signbit(*found) != std::signbit(*exact) ? 1 : 0;
    }
  }
  if (report.frames == 0) {
    return std::nullopt;
  }
  report.error = *error.value();
  report.error_turned = error_turned.value();
  return report;
}

std::array<std::optional<BoneLength>, kBoneNames.size()> bone_lengths(const JointTrack& track) {
  constexpr std::array<std::pair<Joint, Joint>, kBoneNames.size()> kEnds = {{
      {Joint::l_shoulder, Joint::r_shoulder},
      {Joint::l_shoulder, Joint::l_elbow},
      {Joint::r_shoulder, Joint::r_elbow},
      {Joint::l_elbow, Joint::l_wrist},
      {Joint::r_elbow, Joint::r_wrist},
  }};
  std::array<std::optional<BoneLength>, kBoneNames.size()> result;
  for (std::size_t b = 0; b < kEnds.size(); ++b) {
    std::vector<double> lengths;
    for (std::size_t t = 0; t < track.size(); ++t) {
      const auto* const from = joint_at(track, t, kEnds[b].first);
      const auto* const to = joint_at(track, t, kEnds[b].second);
      if (from != nullptr && to != nullptr) {
        lengths.push_back((*to - *from).norm());
      }
    }
    if (lengths.empty()) {
      continue;
    }
    double mean = 0.0;
    for (const double length : lengths) {
      mean += length / static_cast<double>(lengths.size());
    }
    double variance = 0.0;
    for (const double length : lengths) {
      variance += (length - mean) * (length - mean) / static_cast<double>(lengths.size());
    }
    result[b] = BoneLength{mean, mean > 0.0 ? std::sqrt(variance) / mean : 0.0};
  }
  return result;
}

}  // namespace telemime
