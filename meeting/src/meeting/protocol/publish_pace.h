// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "meeting/protocol/pose_frame.h"

namespace telemime::meeting {

/// Frames a second that each of so many participants publishes: 300 / participants, from 5 to 30. Everybody
/// then gets about 300 frames a second.
double publish_rate(std::size_t participants);

/// The same while nobody moves.
inline constexpr double kStillRate = 2.0;

/// Whether a person has not moved from one frame to the other: the same bones, none turned by more than 0.3
/// degrees, the hips moved by less than 3 mm.
bool is_still(const PoseFrame& before, const PoseFrame& now);

/// Says when a frame may go out: evenly spaced slots, and at most one slot early. Times are seconds of one
/// clock.
class PublishPace {
 public:
  /// How many are in the room, oneself among them.
  void set_participants(std::size_t count) { rate_ = publish_rate(count); }
  /// Whether nobody has moved since the last frame that went out.
  bool still(const PoseFrame& frame) const { return last_ && is_still(*last_, frame); }
  /// From when on this frame may go out; long past when it is the first.
  double due(const PoseFrame& frame) const;
  /// It went out.
  void sent(const PoseFrame& frame, double now);

 private:
  double period(const PoseFrame& frame) const;

  double rate_ = publish_rate(1);
  double slot_ = 0.0;  ///< of the last frame that went out; at most one period after that
  std::optional<PoseFrame> last_;
};

}  // namespace telemime::meeting
