// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "support/quick_config.h"
#include "support/synthetic_clip.h"
#include "telemime/tracker/track_frame.h"

/// A run with few evaluations, and a clip of a few frames for it.
namespace telemime {

inline constexpr int kPersonFrames = 6;

// Rendered once for all tests of this program.
inline const support::SyntheticClip& clip() {
  static const support::SyntheticClip the_clip = support::synthetic_clip(12, kPersonFrames);
  return the_clip;
}

inline Config quick_config() {
  Config config = support::quick_config();
  config.registration.iterations = 300;
  config.tracking.patience = 2;
  config.tracking.retry_every = 1;
  return config;
}

inline TrackingRun quick_run(const Config& config) {
  return make_tracking_run(config, clip().camera);
}

/// A run that knows the background.
inline TrackingRun learned_run(const Config& config = quick_config()) {
  TrackingRun run = quick_run(config);
  run.scene.features.learn_background(clip().background);
  return run;
}

/// What the frames show, tracked one after the other.
inline std::vector<MotionFrame> track(const Config& config, const std::vector<Frame>& frames) {
  TrackingRun run = learned_run(config);
  std::vector<MotionFrame> motion;
  for (const Frame& frame : frames) {
    motion.push_back(track_frame(frame, run).estimate.motion);
  }
  return motion;
}

}  // namespace telemime
