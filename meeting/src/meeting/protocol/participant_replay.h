// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "meeting/protocol/recording_file.h"

namespace telemime::meeting {

/// What a participant of a recording says anew.
struct ReplayStep {
  TopicKind kind = TopicKind::pose;  ///< any but `room`
  int page = 0;                      ///< of a board
  std::uint16_t session = 0;         ///< of the participant; another than before: a new run of theirs
  bool here = false;                 ///< of a presence
  std::string payload;               ///< of all but a presence
};

/// Makes what one participant said in a recording fit to be said again: with new session numbers, frames
/// counted from 0, and capture times of another clock with the same differences. All else of a frame stays
/// bit for bit.
class ParticipantReplay {
 public:
  /// `speed`: > 0, how much faster than it was. `session`: the first new one, 1 to 65535; the next ones
  /// follow it. `clock`: the capture time (us) that stands for the beginning of the recording.
  ParticipantReplay(double speed, std::uint16_t session, std::uint64_t clock);
  /// What is said instead of this message of the participant. Nothing for what readers would not take: what
  /// cannot be read, a frame that is no news, what belongs to a session that another one has followed, and a
  /// page of another epoch than the room's. At a speed above 1 frames give way that would be closer than 30 a
  /// second.
  std::optional<ReplayStep> step(const RecordedMessage& message);
  /// The epoch of the recorded room from now on.
  void set_epoch(std::uint32_t epoch) { epoch_ = epoch; }
  std::uint16_t session() const { return session_; }

 private:
  bool follow(std::uint16_t recorded);
  std::optional<ReplayStep> pose(const RecordedMessage& message);
  std::optional<ReplayStep> state(const RecordedMessage& message);
  std::optional<ReplayStep> presence(const RecordedMessage& message);
  std::optional<ReplayStep> chat(const RecordedMessage& message) const;
  std::optional<ReplayStep> board(const RecordedMessage& message) const;
  std::uint64_t captured_of(std::uint64_t at, std::uint64_t recorded);

  double speed_;
  std::uint16_t session_;
  std::uint64_t clock_;
  std::uint16_t chat_shift_;
  std::optional<std::uint32_t> epoch_;
  std::optional<std::uint16_t> recorded_;  ///< the session that is followed
  std::set<std::uint16_t> past_;           ///< sessions that were
  std::optional<std::uint32_t> sequence_;  ///< recorded, of the newest frame
  std::uint64_t captured_ = 0;             ///< recorded, of the newest frame
  std::uint64_t first_captured_ = 0;       ///< recorded, of the session's first frame
  std::uint64_t first_clock_ = 0;          ///< what stands for it
  std::uint64_t last_clock_ = 0;           ///< of the last frame
  std::uint32_t next_sequence_ = 0;
  std::optional<double> last_at_;  ///< when the last frame went, us of the replay
};

/// The epoch that a message `room` tells; nothing when it tells none.
std::optional<std::uint32_t> epoch_of_meeting(std::string_view payload);

/// The page with this epoch in place of its own; nothing when it is none.
std::optional<std::string> page_with_epoch(std::string_view payload, std::uint32_t epoch);

}  // namespace telemime::meeting
