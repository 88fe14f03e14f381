// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/offline.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "telemime/tracker/tracker.h"
#include "telemime/tracking/posterior.h"

namespace telemime {

OfflineTracker::OfflineTracker(const Config& config, const JointLimits& limits)
    : config_(config),
      limits_(limits),
      evaluators_(config.backend, config.threads, config.cues),
      seeds_(config.seed ^ 0x6f66666c696e65ULL) {}

std::optional<OfflineFrame> OfflineTracker::next(const Model& model, const Camera& camera) {
  if (waiting_.empty()) {
    if (finished_) {
      finished_ = false;
      before_.reset();  // who comes next may be somebody else
    }
    return std::nullopt;
  }
  if (decided_ == 0 && waiting_.front().stretch) {
    const auto stretch = static_cast<std::size_t>(config_.offline.stretch);
    const auto most = stretch + static_cast<std::size_t>(config_.offline.overlap);
    const auto end = std::find_if(waiting_.begin(), waiting_.end(),
                                  [](const OfflineFrame& frame) { return !frame.stretch; });
    const auto tracked = static_cast<std::size_t>(std::distance(waiting_.begin(), end));
    if (tracked >= most) {
      decide(most, stretch, model, camera);
    } else if (finished_ || end != waiting_.end()) {
      decide(tracked, tracked, model, camera);
    } else {
      return std::nullopt;
    }
  }
  OfflineFrame frame = std::move(waiting_.front());
  waiting_.pop_front();
  decided_ -= std::min<std::size_t>(decided_, 1);
  before_ = frame.stretch ? std::optional(frame.motion.pose) : std::nullopt;
  frame.stretch.reset();
  return frame;
}

void OfflineTracker::look_back(std::size_t frames, const Model& model) {
  ParticleFilter filter(config_.filter, config_.registration, limits_, evaluators_, seeds_.bits());
  filter.start(waiting_[frames - 1].motion.pose);
  for (std::size_t t = frames; t-- > 0;) {
    StretchFrame& frame = *waiting_[t].stretch;
    frame.candidates.resize(frame.forward);  // an earlier look back may have reached into this stretch
    const FilterResult found = filter.step(
        {.frame = frame.frame,
         .model = model,
         .velocity = config_.tracking.velocity,
         .heading = frame.heading,
         .time_step =
             t + 1 < frames ? steps_between(waiting_[t].motion.time, waiting_[t + 1].motion.time) : 1.0});
    waiting_[t].motion.evaluations += found.evaluations;
    const std::vector<Pose> poses = mode_poses(config_.filter, filter, model.body, found.pose);
    frame.candidates.insert(frame.candidates.end(), poses.begin(), poses.end());
  }
}

void OfflineTracker::decide(std::size_t frames, std::size_t keep, const Model& model, const Camera& camera) {
  look_back(frames, model);
  std::vector<const StretchFrame*> stretch;
  stretch.reserve(frames);
  for (std::size_t t = 0; t < frames; ++t) {
    stretch.push_back(&*waiting_[t].stretch);
  }
  const TrajectoryContext context{.model = model,
                                  .limits = limits_,
                                  .search = config_.registration,
                                  .config = config_.offline,
                                  .evaluators = evaluators_};
  const std::vector<Pose> poses = best_trajectory(context, stretch, before_ ? &*before_ : nullptr, seeds_);
  for (std::size_t t = 0; t < keep; ++t) {
    MotionFrame& motion = waiting_[t].motion;
    const JointPositions joints = motion.joints;
    motion.pose = poses[t];
    complete(motion, model.body, camera);
    if (motion.spread) {
      motion.spread = about(*motion.spread, joints, motion.joints);
    }
    Score score;
    evaluators_.evaluate(stretch[t]->frame, model, {&poses[t], 1}, {&score, 1});
    motion.region_score = score.region();
    motion.contour_score = score.contour();
    motion.evaluations += config_.offline.sweeps * config_.offline.evaluations;
  }
  decided_ = keep;
}

}  // namespace telemime
