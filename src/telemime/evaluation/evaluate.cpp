// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/evaluate.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <map>

#include "telemime/core/errors.h"
#include "telemime/evaluation/error_means.h"

namespace telemime {
namespace {

/// The pose frame of each frame of the truth.
struct Matched {
  std::vector<const MotionFrame*> exact;  ///< null: the pose file has no such frame
  std::vector<const MotionFrame*> last;   ///< the same or the last one before; null before the first
  std::size_t found = 0;
  std::size_t extra = 0;
};

Matched match(const std::vector<MotionFrame>& frames, std::size_t count) {
  Matched matched;
  matched.exact.resize(count, nullptr);
  matched.last.resize(count, nullptr);
  for (const MotionFrame& frame : frames) {
    if (frame.frame < 0 || static_cast<std::size_t>(frame.frame) >= count) {
      ++matched.extra;
      continue;
    }
    matched.exact[static_cast<std::size_t>(frame.frame)] = &frame;
    ++matched.found;
  }
  const MotionFrame* last = nullptr;
  for (std::size_t t = 0; t < count; ++t) {
    // The pose of a frame in which nobody was tracked yet is not one.
    const MotionFrame* const here = matched.exact[t];
    last = here != nullptr && (last != nullptr || here->state == TrackState::tracking) ? here : last;
    matched.last[t] = last;
  }
  return matched;
}

bool is_tracked(const MotionFrame* frame) {
  return frame != nullptr && frame->state == TrackState::tracking;
}

struct Tracks {
  JointTrack estimate;  ///< scored and tracked frames, camera frame
  JointTrack truth;     ///< the same frames
};

Tracks make_tracks(const Matched& matched, const Truth& truth, double scale) {
  Tracks tracks;
  tracks.estimate.resize(truth.frames.size());
  tracks.truth.resize(truth.frames.size());
  for (std::size_t t = 0; t < truth.frames.size(); ++t) {
    if (!truth.is_scored(t) || !is_tracked(matched.exact[t])) {
      continue;
    }
    JointPositions joints = matched.exact[t]->joints;
    for (auto& joint : joints.at) {
      joint *= scale;
    }
    tracks.estimate[t] = as_truth(joints);
    tracks.truth[t] = truth.frames[t];
  }
  return tracks;
}

JointTrack centred(const JointTrack& track) {
  JointTrack result(track.size());
  for (std::size_t t = 0; t < track.size(); ++t) {
    if (track[t]) {
      result[t] = shoulder_centred(*track[t]);
    }
  }
  return result;
}

void count_lost(const Matched& matched, const Truth& truth, Evaluation& result) {
  std::size_t lost = 0;
  std::size_t lost_scored = 0;
  std::size_t empty = 0;
  std::size_t lost_empty = 0;
  for (std::size_t t = 0; t < truth.frames.size(); ++t) {
    const bool is_lost = !is_tracked(matched.exact[t]);
    lost += is_lost ? 1 : 0;
    if (truth.is_scored(t)) {
      ++result.scored_frames;
      lost_scored += is_lost ? 1 : 0;
    }
    if (!truth.is_visible(t)) {
      ++empty;
      lost_empty += is_lost ? 1 : 0;
    }
  }
  if (result.scored_frames == 0) {
    throw Error(ErrorKind::input, truth.name + ": no frame is to be scored",
                "check \"visible\" and \"best_frames\"");
  }
  result.lost = static_cast<double>(lost) / static_cast<double>(truth.frames.size());
  result.lost_scored = static_cast<double>(lost_scored) / static_cast<double>(result.scored_frames);
  if (empty > 0) {
    result.lost_empty = static_cast<double>(lost_empty) / static_cast<double>(empty);
  }
}

// Does the stated spread hold the truth?
struct Coverage {
  Mean all;
  Mean across;
  Mean depth;
  std::array<Mean, kJointCount> by_joint;

  void add(const MotionFrame& frame, const FrameErrors& errors, double scale) {
    // 95 % of a three-dimensional Gaussian lie within this squared Mahalanobis distance.
    constexpr double kChiSquared = 7.8147;
    if (!frame.spread) {
      return;
    }
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!errors[j] || !errors[j]->aligned) {
        continue;
      }
      const Eigen::Matrix3d covariance = frame.spread->covariance[j] * scale * scale;
      const Eigen::Vector3d& error = *errors[j]->aligned;
      // No doubt at all (or what is no covariance) holds no truth.
      const Eigen::LLT<Eigen::Matrix3d> factor(covariance);
      const bool holds = factor.info() == Eigen::Success && error.dot(factor.solve(error)) <= kChiSquared;
      const double inside = holds ? 1.0 : 0.0;
      by_joint[j].add(inside);
      const Joint joint = static_cast<Joint>(j);
      if (std::find(kScoredJoints.begin(), kScoredJoints.end(), joint) != kScoredJoints.end()) {
        all.add(inside);
        across.add(std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1))));
        depth.add(std::sqrt(covariance(2, 2)));
      }
    }
  }
};

void measure_errors(const Matched& matched, const Camera& input, const Truth& truth, Evaluation& result) {
  ErrorCollector tracked;
  ErrorCollector all;
  Mean region;
  Mean contour;
  Coverage coverage;
  for (std::size_t t = 0; t < truth.frames.size(); ++t) {
    if (!truth.is_scored(t)) {
      continue;
    }
    const MotionFrame* const frame = matched.last[t];
    if (frame == nullptr) {
      ++result.unmeasured_frames;
      continue;
    }
    const FrameErrors errors =
        measure_frame(*frame, input, truth.frames[t], truth.camera, result.fitted_scale.value_or(1.0));
    all.add(errors);
    if (!is_tracked(matched.exact[t])) {
      continue;
    }
    tracked.add(errors);
    coverage.add(*frame, errors, result.fitted_scale.value_or(1.0));
    region.add(frame->region_score);
    contour.add(frame->contour_score);
    result.mistracked += frame->region_score > result.options.max_region_score ||
                                 frame->contour_score > result.options.max_contour_score
                             ? 1
                             : 0;
    if (arms_are_swapped(*frame, input, truth.frames[t], truth.camera)) {
      result.swapped.push_back(frame->frame);
    }
  }
  result.all = all.report();
  result.tracked = tracked.report();
  result.covered = coverage.all.value();
  result.stated_across = coverage.across.value();
  result.stated_depth = coverage.depth.value();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    result.covered_by_joint[j] = coverage.by_joint[j].value();
  }
  result.mean_region = region.value();
  result.mean_contour = contour.value();
}

std::vector<StageTime> stage_times(const std::vector<MotionFrame>& frames) {
  std::vector<std::pair<std::string, std::vector<double>>> samples;
  for (const MotionFrame& frame : frames) {
    for (const auto& [stage, ms] : frame.stage_ms) {
      const auto found = std::find_if(samples.begin(), samples.end(),
                                      [&name = stage](const auto& entry) { return entry.first == name; });
      if (found == samples.end()) {
        samples.push_back({stage, {ms}});
      } else {
        found->second.push_back(ms);
      }
    }
  }
  std::vector<StageTime> times;
  times.reserve(samples.size());
  for (const auto& [stage, values] : samples) {
    times.push_back({stage, *quantile(values, 0.5), *quantile(values, 0.95)});
  }
  return times;
}

}  // namespace

double fit_scale(const JointTrack& estimate, const JointTrack& truth) {
  double product = 0.0;
  double square = 0.0;
  for (std::size_t t = 0; t < std::min(estimate.size(), truth.size()); ++t) {
    const auto p = estimate[t] ? shoulder_centred(*estimate[t]) : std::nullopt;
    const auto q = truth[t] ? shoulder_centred(*truth[t]) : std::nullopt;
    if (!p || !q) {
      continue;
    }
    for (const Joint joint : {Joint::l_shoulder, Joint::r_shoulder, Joint::l_elbow, Joint::r_elbow,
                              Joint::l_wrist, Joint::r_wrist}) {
      const auto j = static_cast<std::size_t>(joint);
      if ((*p)[j] && (*q)[j]) {
        product += (*p)[j]->dot(*(*q)[j]);
        square += (*p)[j]->squaredNorm();
      }
    }
  }
  return square > 0.0 && product > 0.0 ? product / square : 1.0;
}

std::vector<MotionFrame> numbered_by_time(const std::vector<MotionFrame>& frames, double fps) {
  std::map<std::int64_t, const MotionFrame*> nearest;
  const auto distance = [fps](const MotionFrame& frame, std::int64_t number) {
    return std::abs(frame.time * fps - static_cast<double>(number));
  };
  for (const MotionFrame& frame : frames) {
    const std::int64_t number = std::llround(frame.time * fps);
    const auto [place, is_new] = nearest.try_emplace(number, &frame);
    if (!is_new && distance(frame, number) < distance(*place->second, number)) {
      place->second = &frame;
    }
  }
  std::vector<MotionFrame> numbered;
  numbered.reserve(nearest.size());
  for (const auto& [number, frame] : nearest) {
    numbered.push_back(*frame);
    numbered.back().frame = number;
  }
  return numbered;
}

bool has_variable_rate(const std::vector<MotionFrame>& frames, double fps) {
  return std::any_of(frames.begin(), frames.end(), [fps](const MotionFrame& frame) {
    return std::abs(frame.time * fps - static_cast<double>(frame.frame)) > 0.5;
  });
}

Evaluation evaluate(const std::vector<MotionFrame>& given, const Camera& input, const Truth& truth,
                    const EvaluationOptions& options) {
  const std::vector<MotionFrame> frames = options.by_time ? numbered_by_time(given, truth.fps) : given;
  const Matched matched = match(frames, truth.frames.size());
  if (matched.found == 0) {
    throw Error(ErrorKind::input, "the poses and " + truth.name + " have no frame in common",
                "are they of the same clip?");
  }
  Evaluation result;
  result.options = options;
  result.truth_name = truth.name;
  result.fps = truth.fps;
  result.truth_frames = truth.frames.size();
  result.pose_frames = matched.found;
  result.extra_pose_frames = matched.extra;
  if (!truth.scale_known) {
    const Tracks unscaled = make_tracks(matched, truth, 1.0);
    result.fitted_scale = fit_scale(unscaled.estimate, unscaled.truth);
  }
  count_lost(matched, truth, result);
  measure_errors(matched, input, truth, result);

  const Tracks tracks = make_tracks(matched, truth, result.fitted_scale.value_or(1.0));
  result.jitter = wrist_jitter(tracks.estimate);
  result.truth_jitter = wrist_jitter(tracks.truth);
  result.lag = lag_behind(centred(tracks.estimate), centred(tracks.truth));
  result.turn = measure_turn(tracks.estimate, tracks.truth);
  result.bones = bone_lengths(tracks.estimate);
  result.truth_bones = bone_lengths(tracks.truth);
  result.hands = measure_hands(frames, truth, result.fitted_scale.value_or(1.0));
  result.head = measure_heads(frames, truth);
  result.times = stage_times(frames);
  return result;
}

}  // namespace telemime
