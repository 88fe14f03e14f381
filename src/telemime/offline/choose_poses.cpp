// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/choose_poses.h"

#include <utility>
#include <vector>

#include "telemime/core/time_base.h"
#include "telemime/tracking/posterior.h"

namespace telemime {
namespace {

bool may_be_chosen(const FrameRecord& record) {
  return is_tracked(record) && record.estimate.prepared;
}

// Adds the poses that a particle filter finds going backward in time over the first undecided records to the
// candidates of each.
void look_back(const Tracker& tracker, const Model& model, WindowState& window, RecordQueue& queue,
               std::vector<TrajectoryFrame>& frames) {
  FilterState filter(window.seeds.bits());
  const auto record = [&](std::size_t t) -> FrameRecord& { return queue.records[queue.chosen + t]; };
  start_filter(record(frames.size() - 1).estimate.motion.pose, tracker.limits, filter);
  for (std::size_t t = frames.size(); t-- > 0;) {
    MotionFrame& motion = record(t).estimate.motion;
    const FilterResult found =
        tracker.filter->step({.frame = frames[t].frame,
                              .model = model,
                              .velocity = tracker.config.tracking.velocity,
                              .heading = record(t).estimate.heading,
                              .time_step = t + 1 < frames.size() ? frames[t + 1].time_step : 1.0},
                             filter);
    motion.evaluations += found.evaluations;
    const std::vector<Pose> poses =
        mode_poses(tracker.config.filter, filter.particles, model.body, found.pose);
    frames[t].candidates.insert(frames[t].candidates.end(), poses.begin(), poses.end());
  }
}

// Chooses among the poses of the first `count` undecided records together, and keeps the first `keep`.
void choose_window(const Tracker& tracker, const Model& model, std::size_t count, std::size_t keep,
                   WindowState& window, RecordQueue& queue) {
  // The candidates of both directions of time.
  std::vector<TrajectoryFrame> frames;
  frames.reserve(count);
  double before = window.before_time;
  for (std::size_t t = 0; t < count; ++t) {
    FrameEstimate& estimate = queue.records[queue.chosen + t].estimate;
    const double time = estimate.motion.time;
    frames.push_back({.frame = std::move(*estimate.prepared),
                      .heading = estimate.heading,
                      .candidates = estimate.modes,
                      .forward = estimate.modes.size(),
                      .time_step = window.before || t > 0 ? steps_between(before, time) : 1.0});
    before = time;
  }
  look_back(tracker, model, window, queue, frames);
  // The cheapest way through them.
  const TrajectoryContext context{.model = model,
                                  .limits = tracker.limits,
                                  .search = tracker.config.registration,
                                  .config = tracker.config.offline,
                                  .evaluators = *tracker.evaluators};
  const std::vector<Pose> poses =
      best_trajectory(context, frames, window.before ? &*window.before : nullptr, window.seeds);
  // Joints, spread and scores of the poses that stay.
  for (std::size_t t = 0; t < keep; ++t) {
    FrameEstimate& estimate = queue.records[queue.chosen + t].estimate;
    MotionFrame& motion = estimate.motion;
    const JointPositions joints = motion.joints;
    motion.pose = poses[t];
    place_joints(model.body, tracker.camera, motion);
    if (motion.spread) {
      motion.spread = about(*motion.spread, joints, motion.joints);
    }
    Score score;
    tracker.evaluators->evaluate(frames[t].frame, model, {&poses[t], 1}, {&score, 1});
    motion.region_score = score.region();
    motion.contour_score = score.contour();
    motion.evaluations += tracker.config.offline.sweeps * tracker.config.offline.evaluations;
  }
  window.before = poses[keep - 1];
  window.before_time = queue.records[queue.chosen + keep - 1].estimate.motion.time;
  // The next window begins with the others.
  for (std::size_t t = 0; t < count; ++t) {
    FrameEstimate& estimate = queue.records[queue.chosen + t].estimate;
    if (t < keep) {
      estimate.prepared.reset();
      estimate.modes = {};
    } else {
      estimate.prepared = std::move(frames[t].frame);
    }
  }
  queue.chosen += keep;
}

}  // namespace

WindowState::WindowState(const Config& config) : seeds(config.seed ^ 0x6f66666c696e65ULL) {}

void choose_poses(const Tracker& tracker, const Model& model, bool last, WindowState& window,
                  RecordQueue& queue) {
  const TrajectoryConfig& config = tracker.config.offline;
  while (queue.chosen < queue.filled) {
    // The next tracked frames, up to a pause.
    const auto time = [&](std::size_t t) { return queue.records[queue.chosen + t].estimate.motion.time; };
    // Whether the first `count` undecided records last for `units` (1/25 s), the last of them included.
    constexpr double kSlack = 0.5;
    constexpr std::size_t kMostKept = kMostWaiting * 4 / 5;  // of a fast input's frames that wait
    const auto last_for = [&](std::size_t count, int units) {
      return count > 0 && kUnitsPerSecond * (time(count - 1) - time(0)) > units - 1 - kSlack;
    };
    if (window.before && !are_neighbours(window.before_time, time(0))) {
      window.before.reset();
    }
    std::size_t tracked = 0;
    std::size_t stretch = 0;
    const auto whole = [&] {
      return last_for(tracked, config.stretch + config.overlap) || tracked == kMostWaiting;
    };
    while (!whole() && queue.chosen + tracked < queue.filled &&
           may_be_chosen(queue.records[queue.chosen + tracked]) &&
           (tracked == 0 || are_neighbours(time(tracked - 1), time(tracked)))) {
      ++tracked;
      stretch += last_for(tracked - 1, config.stretch) || stretch == kMostKept ? 0 : 1;
    }
    const bool at_end = queue.chosen + tracked == queue.filled;
    if (tracked == 0) {
      window.before.reset();
      ++queue.chosen;
    } else if (whole()) {
      choose_window(tracker, model, tracked, stretch, window, queue);
    } else if (last || !at_end) {
      choose_window(tracker, model, tracked, tracked, window, queue);
    } else {
      return;
    }
  }
  if (last) {
    window.before.reset();  // the next person may be somebody else
  }
}

void keep_forward_poses(RecordQueue& queue) {
  queue.chosen = queue.filled;
}

}  // namespace telemime
