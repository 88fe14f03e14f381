// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "telemime/tracker/smoother.h"
#include "telemime/tracker/track_frame.h"

namespace telemime {

/// The frames of a file that are not written yet, in the order of time, and how far each pass has come: the
/// first `filled` records are final for `fill_back`, the first `chosen` of these for `choose_poses`, and the
/// first `smoothed` of these have been smoothed forward in time.
struct RecordQueue {
  std::deque<FrameRecord> records;
  std::size_t filled = 0;
  std::size_t chosen = 0;
  std::size_t smoothed = 0;
};

/// Frames that wait together, at most: with a fast input the windows of time are shorter, not the memory
/// larger.
inline constexpr std::size_t kMostWaiting = 600;

inline bool is_tracked(const FrameRecord& record) {
  return record.estimate.motion.state == TrackState::tracking;
}

/// Whether the poses at two times (s) may be decided together: no pause lies between them.
inline bool are_neighbours(double before, double after) {
  return after - before <= kLongestGap;
}

/// Shrinks a picture that waits to be drawn, or releases it (`longest_side` 0): some hundred may wait at a
/// time.
void keep_picture(int longest_side, Frame& frame);

}  // namespace telemime
