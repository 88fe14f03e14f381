// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/gap_filler.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace telemime {

GapFiller::GapFiller(const Tracker& tracker)
    : tracker_(tracker),
      evaluators_(tracker.config().backend, tracker.config().threads, tracker.config().cues),
      seeds_(tracker.config().seed ^ 0x67617073ULL) {}

std::size_t GapFiller::push(GapFrame frame) {
  waiting_.push_back(std::move(frame));
  std::size_t filled = 0;
  if (waiting_.back().decided.motion.state == TrackState::tracking) {
    filled = fill();
    finish();
  } else if (!waiting_.back().seen) {
    finish();  // nobody is followed back across it
  } else if (waiting_.size() > static_cast<std::size_t>(tracker_.config().tracking.fill_back)) {
    ++decided_;
  }
  return filled;
}

std::optional<OfflineFrame> GapFiller::next() {
  if (decided_ == 0) {
    return std::nullopt;
  }
  OfflineFrame frame = std::move(waiting_.front().decided);
  waiting_.pop_front();
  --decided_;
  return frame;
}

std::size_t GapFiller::fill() {
  const Config& config = tracker_.config();
  const std::size_t found = waiting_.size() - 1;
  if (found == decided_ || !waiting_[found - 1].seen) {
    return 0;
  }
  ParticleFilter filter(config.filter, config.registration, tracker_.limits(), evaluators_, seeds_.bits());
  filter.start(waiting_[found].decided.motion.pose, true);
  struct Followed {
    MotionFrame motion;
    std::optional<StretchFrame> stretch;
  };
  std::vector<Followed> followed;  // the last frame first
  std::size_t good = 0;            // so many of them: the body fits in the last of these
  double bad_for = 0.0;            // 1/25 s
  int bad_frames = 0;              // in a row
  // As long as Tracker::watch would go on.
  const auto goes_on = [&] {
    return bad_for < config.tracking.patience || bad_frames < std::min(2, config.tracking.patience);
  };
  for (std::size_t t = found; t-- > decided_ && waiting_[t].seen && goes_on();) {
    Followed frame{waiting_[t].decided.motion, std::nullopt};
    MotionFrame& motion = frame.motion;
    const double steps = steps_between(motion.time, waiting_[t + 1].decided.motion.time);
    const FilterResult result = filter.step({.frame = *waiting_[t].seen,
                                             .model = tracker_.model(),
                                             .velocity = config.tracking.velocity,
                                             .time_step = steps});
    motion.state = TrackState::tracking;
    motion.pose = result.pose;
    motion.region_score = result.score.region();
    motion.contour_score = result.score.contour();
    motion.evaluations += result.evaluations;
    motion.spread = tracker_.spread(filter, result);
    complete(motion, tracker_.model().body, tracker_.camera());
    if (config.look_back) {
      std::vector<Pose> poses = mode_poses(config.filter, filter, tracker_.model().body, result.pose);
      const std::size_t count = poses.size();
      frame.stretch = StretchFrame{std::move(*waiting_[t].seen), result.heading, std::move(poses), count};
    }
    followed.push_back(std::move(frame));
    const bool fits = result.score.region() <= config.tracking.lost_region;
    good = fits ? followed.size() : good;
    bad_for = fits ? 0.0 : bad_for + steps;
    bad_frames = fits ? 0 : bad_frames + 1;
  }
  for (std::size_t i = 0; i < good; ++i) {
    OfflineFrame& frame = waiting_[found - 1 - i].decided;
    frame.motion = std::move(followed[i].motion);
    frame.stretch = std::move(followed[i].stretch);
    frame.note.clear();
  }
  return good;
}

}  // namespace telemime
