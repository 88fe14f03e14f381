// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "meeting/protocol/recording_file.h"

namespace telemime::meeting {

/// A message of a participant, to be sent again.
struct ReplayStep {
  TopicKind kind = TopicKind::pose;  ///< any but `meeting`
  int page = 0;                      ///< of a board
  std::uint16_t session = 0;         ///< of the participant; a new number begins a new run
  bool here = false;                 ///< of a presence
  std::string payload;               ///< of anything but a presence
};

/// Prepares the recorded messages of one participant for sending: with new session numbers, frames counted
/// from 0, and capture times of another clock with the same differences. The rest of a frame stays bit for
/// bit.
class ParticipantReplay {
 public:
  /// `speed`: > 0, the playback speed. `session`: the first new session, 1 to 65535; later ones count up from
  /// it. `clock`: the capture time (us) that corresponds to the beginning of the recording.
  ParticipantReplay(double speed, std::uint16_t session, std::uint64_t clock);
  /// What to send for this message of the participant. Returns nothing for what readers would not accept: an
  /// invalid message, a frame that is not newer, a message of an earlier session, a page of another epoch
  /// than the meeting's. At a speed above 1, frames are dropped to stay within 30 per second.
  std::optional<ReplayStep> step(const RecordedMessage& message);
  /// Sets the epoch of the recorded meeting from now on.
  void set_epoch(std::uint32_t epoch) { epoch_ = epoch; }
  std::uint16_t session() const { return session_; }

 private:
  bool follow(std::uint16_t recorded, std::uint64_t at);
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
  std::optional<std::uint16_t> recorded_;            ///< the session being replayed
  bool left_ = false;                                ///< it has said goodbye
  std::map<std::uint16_t, std::uint64_t> replaced_;  ///< earlier sessions, and when a newer one began, us
  std::set<std::uint16_t> ended_;          ///< those that had sent poses: only their presence revives them
  std::optional<std::uint32_t> sequence_;  ///< recorded, of the newest frame
  std::uint64_t captured_ = 0;             ///< recorded, of the newest frame
  std::uint64_t first_captured_ = 0;       ///< recorded, of the first frame of the session
  std::uint64_t first_clock_ = 0;          ///< the time that corresponds to it
  std::uint64_t last_clock_ = 0;           ///< of the last frame
  std::uint32_t next_sequence_ = 0;
  std::optional<double> last_at_;  ///< when the last frame was sent, us of the replay
};

}  // namespace telemime::meeting
