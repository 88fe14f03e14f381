// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "telemime/body/motion_frame.h"
#include "telemime/core/frame.h"
#include "telemime/tracker/config.h"
#include "telemime/tracking/particle_filter.h"
#include "telemime/tracking/trajectory.h"

namespace telemime {

/// A frame on its way through OfflineTracker.
struct OfflineFrame {
  Frame frame;  ///< its image may be empty
  std::string note;
  MotionFrame motion;
  std::optional<StretchFrame> stretch;  ///< nothing where nobody is tracked
  std::vector<unsigned char> packed;    ///< its image, compressed, of put_away(); else empty
};

/// Decides about the poses of a file with what comes after them, too: a second particle filter runs backward
/// in time, and best_trajectory() chooses among what both found. Frames come out some
/// TrajectoryConfig::stretch and overlap later. Same seed, same result.
class OfflineTracker {
 public:
  /// `limits` must stay. Throws Error(config).
  OfflineTracker(const Config& config, const JointLimits& limits);

  void push(OfflineFrame frame) { waiting_.push_back(std::move(frame)); }
  /// No frame comes any more, or none of the same person: next() gives the rest.
  void finish() { finished_ = true; }
  /// The frames that wait keep the poses that the forward filter found.
  void give_up() { decided_ = waiting_.size(); }
  /// The next decided frame, in the order in which they came; nothing when it must still wait. `camera`: of
  /// the input images.
  std::optional<OfflineFrame> next(const Model& model, const Camera& camera);

 private:
  void decide(std::size_t frames, std::size_t keep, const Model& model, const Camera& camera);
  void look_back(std::size_t frames, const Model& model);

  Config config_;
  const JointLimits& limits_;
  Evaluators evaluators_;
  Random seeds_;
  std::deque<OfflineFrame> waiting_;
  std::size_t decided_ = 0;     ///< of the waiting frames, from the first on
  std::optional<Pose> before_;  ///< of the frame before the first waiting one, where it was tracked
  bool finished_ = false;
};

}  // namespace telemime
