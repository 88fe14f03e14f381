// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "telemime/body/body.h"
#include "telemime/body/motion_frame.h"
#include "telemime/core/camera.h"
#include "telemime/core/settings.h"
#include "telemime/tracker/interval_smoother.h"
#include "telemime/tracker/one_euro.h"

namespace telemime {

/// How body and fingers move, for the smoothing of files.
struct FileSmoothing {
  IntervalModel angles = {.noise = 0.03, .motion = 1.0, .sudden = 2.0};  ///< rad
  IntervalModel root = {.noise = 0.01, .motion = 0.3, .sudden = 2.0};    ///< m
  IntervalModel fingers = {.noise = 0.1, .motion = 2.5, .sudden = 2.0};  ///< rad, where seen well
};

/// Settings of the smoother; the table (settings_of) gives the meaning, unit and range of each.
struct SmoothingOptions {
  std::string name = "one-euro";
  double recursive_coefficient = 0.6;
  OneEuroOptions angles = {1.0, 4.0, 1.0};
  OneEuroOptions root = {1.0, 10.0, 1.0};
  OneEuroOptions hands = {1.5, 1.5, 1.0};
  int look_ahead = 12;
  FileSmoothing file;
};

/// Settings of time count in 1/25 s.
SettingTable settings_of(SmoothingOptions& options);

/// The longest time between two frames (s) that counts as motion: nothing is known across a longer pause.
inline constexpr double kLongestGap = 1.0;

/// Steadies a stream of frames; the One-Euro filter smooths an arm outside the image more. Rotations are
/// smoothed, not angles (those of fingers excepted), so that nothing happens where angles jump; the joints
/// follow by forward kinematics and the pixels by what the joints move in the image. A lost frame, or one
/// that is not finite, passes unchanged and ends the memory; so does a time that does not advance or that
/// advances more than kLongestGap. The face is steadied in lost frames, too. Smoothed angles may leave the
/// joint limits by little.
class Smoother {
 public:
  Smoother() = default;
  Smoother(const Smoother&) = delete;
  Smoother& operator=(const Smoother&) = delete;
  virtual ~Smoother() = default;

  /// Frames in the order of their time.
  virtual MotionFrame operator()(const MotionFrame& frame) = 0;
};

/// The frame with another pose: joints by forward kinematics, pixels by what the joints move in the image.
MotionFrame with_pose(const MotionFrame& frame, const Pose& pose, const Body& body, const Camera& camera);

/// `camera` is that of frame.pixels. Throws Error(config) when a name or a number is not usable.
std::unique_ptr<Smoother> make_smoother(const SmoothingOptions& options, const Body& body,
                                        const Camera& camera);

}  // namespace telemime
