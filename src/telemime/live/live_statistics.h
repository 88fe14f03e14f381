// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace telemime {

/// When a live frame passed each stage; seconds of one clock.
struct FrameTimes {
  std::int64_t index = 0;    ///< of the input
  double taken = 0.0;        ///< by the camera; a usable_stamp
  double begun = 0.0;        ///< extraction of its features began
  double seen = 0.0;         ///< features done
  double searched = 0.0;     ///< search begun
  double decided = 0.0;      ///< pose estimated and passed on
  double networks_ms = 0.0;  ///< part of the features
};

/// Medians over the last frames, each with the mean of two frames in a row, ms.
struct StageTimes {
  double wait = 0.0;      ///< from the camera to the features
  double features = 0.0;  ///< the image side
  double networks = 0.0;  ///< part of it
  double queue = 0.0;     ///< from there to the search
  double search = 0.0;    ///< search, smoothing and passing on
  double total = 0.0;     ///< from the camera to the pose
  double total_p95 = 0.0;
};

/// Whether the image side took longer for a frame than the camera takes between two: then hands take turns.
/// `before` is the last frame and becomes this one.
bool falls_behind(const FrameTimes& now, FrameTimes& before);

struct LiveRates {
  double input = 0.0;    ///< frames per second that the camera delivered
  double tracked = 0.0;  ///< frames per second that were tracked
  std::int64_t frames = 0;
  std::int64_t dropped = 0;  ///< frames of the camera that were never processed
  StageTimes ms;
};

/// Frame::taken in a form that statistics and pages can use. Sources may give no time stamps, or stamps of
/// another clock, in the future or going backward. Returns `taken` if it lies in the ten seconds before
/// `now`, otherwise `now`, but never less than `last`, the stamp of the previous frame. All in seconds of one
/// monotonic clock; last <= now.
double usable_stamp(double taken, double last, double now);

/// The frame rate of an input by its time stamps, since its last interruption (no frame for 2 s).
class InputRate {
 public:
  /// A frame: its number, dropped ones included, and its time in s.
  void add(std::int64_t index, double time);
  /// The stated rate, or that of the time stamps where they contradict it. A camera may be slow in dim light,
  /// but a stream that states its clock rate is wrong.
  double believable(double stated) const;

 private:
  std::int64_t first_ = 0;
  std::int64_t last_ = -1;
  double first_time_ = 0.0;
  double last_time_ = 0.0;
};

/// Rates and times over the last 100 frames, but never across an interruption of the camera (no image for 2
/// s). Not thread-safe.
class LiveStatistics {
 public:
  void add(const FrameTimes& times);
  /// At `now`: a camera that has stopped has no rate.
  LiveRates rates(double now) const;
  void clear();

 private:
  std::deque<FrameTimes> last_;
  std::int64_t frames_ = 0;
  std::int64_t dropped_ = 0;
};

/// The last 250 latencies that pages reported, ms.
class LatencyRecord {
 public:
  struct Summary {
    double median = 0.0;
    double p95 = 0.0;
  };
  /// Values that no page can have measured (negative, above 10 s, not a number) are not counted.
  void add(double ms);
  /// Nothing before the first value.
  std::optional<Summary> summary() const;

 private:
  std::deque<double> last_;
};

/// The quantile `q` (0 to 1) of the values; 0 if there are none.
double quantile_of(std::vector<double> values, double q);

}  // namespace telemime
