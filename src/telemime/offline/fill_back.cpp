// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/fill_back.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "telemime/core/time_base.h"
#include "telemime/tracker/lost_and_found.h"

namespace telemime {
namespace {

// A frame in which somebody was seen, but not tracked.
bool may_be_filled(const FrameRecord& record) {
  return !is_tracked(record) && record.estimate.prepared && record.features.person_present;
}

struct FollowedFrame {
  FrameEstimate estimate;
  bool fits = false;
};

// One more frame, going back in time.
FollowedFrame follow_back(const Tracker& tracker, const TrackerState& state, const FrameRecord& record,
                          double steps, FilterState& filter) {
  FrameEstimate result;
  result.motion = record.estimate.motion;
  MotionFrame& motion = result.motion;
  const FilterResult found = tracker.filter->step({.frame = *record.estimate.prepared,
                                                   .model = state.model,
                                                   .velocity = tracker.config.tracking.velocity,
                                                   .time_step = steps},
                                                  filter);
  motion.state = TrackState::tracking;
  motion.pose = found.pose;
  motion.region_score = found.score.region();
  motion.contour_score = found.score.contour();
  motion.evaluations += found.evaluations;
  motion.spread = spread_of_filter(tracker, state, *record.estimate.prepared, filter, found);
  if (record.features.hands) {
    HandState hands{.sizes = state.hands.sizes, .frames = state.hands.frames, .last = {}};
    motion.hands = observe_hands(*record.features.hands,
                                 {.body = state.model.body,
                                  .kinematics = forward_kinematics(state.model.body, found.pose),
                                  .camera = tracker.working_camera,
                                  .time = motion.time},
                                 hands);
  }
  place_joints(state.model.body, tracker.camera, motion);
  if (tracker.config.look_back) {
    result.heading = found.heading;
    result.modes = mode_poses(tracker.config.filter, filter.particles, state.model.body, found.pose);
  }
  const bool fitting = fits(found.score, *record.estimate.prepared, tracker);
  return {.estimate = std::move(result), .fits = fitting};
}

// Goes back from the record at the end of the queue; returns how many records before it became tracked.
std::size_t fill_from_end(const Tracker& tracker, const TrackerState& state, Random& seeds,
                          RecordQueue& queue) {
  std::deque<FrameRecord>& records = queue.records;
  const std::size_t found = records.size() - 1;
  if (found == queue.filled || !may_be_filled(records[found - 1])) {
    return 0;
  }
  FilterState filter(seeds.bits());
  start_filter(records[found].estimate.motion.pose, tracker.limits, filter, true);
  const TrackingConfig& config = tracker.config.tracking;
  std::vector<FrameEstimate> followed;  // the last frame first
  std::size_t good = 0;                 // number of frames up to the last that the body fits
  double bad_for = 0.0;                 // 1/25 s
  int bad_frames = 0;                   // in a row
  // As long as check_fit() would go on.
  const auto goes_on = [&](std::size_t t) {
    return (bad_for < config.patience || bad_frames < std::min(2, config.patience)) &&
           are_neighbours(records[t].estimate.motion.time, records[t + 1].estimate.motion.time);
  };
  for (std::size_t t = found; t-- > queue.filled && may_be_filled(records[t]) && goes_on(t);) {
    const double before = records[t].estimate.motion.time;
    const double now = records[t + 1].estimate.motion.time;
    FollowedFrame next = follow_back(tracker, state, records[t], steps_between(before, now), filter);
    followed.push_back(std::move(next.estimate));
    good = next.fits ? followed.size() : good;
    bad_for = next.fits ? 0.0 : bad_for + units_between(before, now);
    bad_frames = next.fits ? 0 : bad_frames + 1;
  }
  for (std::size_t i = 0; i < good; ++i) {
    FrameEstimate& estimate = records[found - 1 - i].estimate;
    followed[i].prepared = std::move(estimate.prepared);
    estimate = std::move(followed[i]);
  }
  return good;
}

// These records are final; only choose_poses() looks at the images of tracked frames again.
void finish_filling(const Tracker& tracker, std::size_t count, RecordQueue& queue) {
  for (std::size_t t = queue.filled; t < count; ++t) {
    FrameRecord& record = queue.records[t];
    if (!is_tracked(record) || !tracker.config.look_back) {
      record.estimate.prepared.reset();
    }
  }
  queue.filled = count;
}

}  // namespace

Random fill_back_seeds(const Config& config) {
  return Random(config.seed ^ 0x67617073ULL);
}

std::size_t fill_back(const Tracker& tracker, const TrackerState& state, Random& seeds, RecordQueue& queue) {
  const std::size_t count = queue.records.size();
  const int longest = tracker.config.tracking.fill_back;
  const FrameRecord& last = queue.records.back();
  std::size_t filled = 0;
  if (!tracker.filter || longest == 0) {
    finish_filling(tracker, count, queue);
  } else if (is_tracked(last)) {
    filled = fill_from_end(tracker, state, seeds, queue);
    finish_filling(tracker, count, queue);
  } else if (!may_be_filled(last)) {
    finish_filling(tracker, count, queue);  // nobody is followed back across it
  } else {
    const double since = last.estimate.motion.time - kTimeUnit * (longest - 0.01);
    std::size_t late = queue.filled;
    while (late < count &&
           (queue.records[late].estimate.motion.time <= since || count - late > kMostWaiting)) {
      ++late;
    }
    finish_filling(tracker, late, queue);
  }
  return filled;
}

void end_fill_back(const Tracker& tracker, RecordQueue& queue) {
  finish_filling(tracker, queue.records.size(), queue);
}

}  // namespace telemime
