// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

namespace telemime {

/// Windows of time are set in 1/25 s, the time of a frame of most cameras, whatever the rate of the input.
inline constexpr double kUnitsPerSecond = 25.0;
inline constexpr double kTimeUnit = 1.0 / kUnitsPerSecond;  ///< s

/// Time between two frames in 1/25 s: exactly 1 where it is about that or not known. Times in s.
double units_between(double before, double now);

/// Time since the first of successive frames of a kind: `before` of the last frame, empty if that was none.
/// `elapsed`: since then. Empty if this frame is none, either.
std::optional<double> time_since(std::optional<double> before, bool is_one, double elapsed);

/// Frames per second by the time stamps (s) of successive frames: of the usual step where most steps are
/// equal (frames that were left out do not count), otherwise of the mean step; pauses do not count. A result
/// within 1 % of a usual rate (25, 29.97, 60 ...) is that rate. Empty for fewer than three time stamps.
std::optional<double> rate_of(const std::vector<double>& stamps);

/// Whether two rates are the same but for rounding: within 2 %.
bool same_rate(double a, double b);

/// Seconds from the first frame, by the time stamps of an input. Time always increases: a frame without a
/// usable time stamp follows the frame before at the rate, one that repeats or runs back a little comes
/// directly after it. A stamp far from the one before is wrong where the next one goes on from there: its
/// frame has none. After another jump back, or one ahead of more than an hour, time goes on at the rate:
/// such stamps start again (joined recordings).
class TimeBase {
 public:
  explicit TimeBase(double fps) : step_(1.0 / fps) {}

  /// The time of the next frame. `stamp` in s; empty or not finite: the frame has none. `following`: that of
  /// the frame after it; empty: it has none, or no frame follows.
  double next(std::optional<double> stamp, std::optional<double> following = std::nullopt);

 private:
  bool is_wrong(double time, std::optional<double> following) const;

  double step_;
  double time_ = -1.0;           // of the last frame; negative before the first
  std::optional<double> start_;  // time stamp of time 0
};

}  // namespace telemime
