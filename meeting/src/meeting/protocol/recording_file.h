// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "meeting/protocol/topics.h"

namespace telemime::meeting {

/// Maximum number of participants of a recording: their names come from outside, so memory needs a bound.
inline constexpr std::size_t kMostRecordedParticipants = 1000;
/// Times in a recording are less than this, us (285 years): their differences are exact as floating point.
inline constexpr std::uint64_t kTimeEnd = std::uint64_t{1} << 53U;
/// Size of the head of a recording's file: eight fixed bytes and the version.
inline constexpr std::size_t kRecordingHead = 12;

/// The first record: which meeting, and when.
struct RecordingStart {
  MeetingAddress meeting;
  std::string began;  ///< UTC, "2026-11-22T15:30:00Z"; printable ASCII, at most 64 bytes
};
/// A message of the meeting. `at` of this and of the others: us since the start of the recording, monotonic.
struct RecordedMessage {
  std::uint64_t at = 0;
  Topic topic;
  std::string payload;
};
/// From here on nothing was received, until ConnectionRestored.
struct ConnectionLost {
  std::uint64_t at = 0;
  std::string reason;  ///< at most 1024 bytes
};
struct ConnectionRestored {
  std::uint64_t at = 0;
};
/// The number of messages before this moment that are missing because the disk was too slow.
struct MessagesDropped {
  std::uint64_t at = 0;
  std::uint32_t count = 0;
};
/// The recording was closed properly. Nothing follows.
struct RecordingEnd {
  std::uint64_t at = 0;
};
using Record = std::variant<RecordingStart, RecordedMessage, ConnectionLost, ConnectionRestored,
                            MessagesDropped, RecordingEnd>;

/// The time of a record, us; 0 for the start.
std::uint64_t time_of(const Record& record);

/// Encodes a recording (meeting/docs/recording.md), one record at a time.
class RecordingEncoder {
 public:
  /// The head of the file and its first record. Throws Error(usage) when the address or `began` is invalid.
  static std::string begin(const RecordingStart& start);
  /// The bytes of the next record; nothing for a message of one participant too many. Throws Error(usage) for
  /// a second start, anything after the end, a time out of range or before the previous one, and a message
  /// that is too long.
  std::optional<std::string> encode(const Record& record);

 private:
  std::optional<std::string> message(const RecordedMessage& message);

  std::map<std::string, std::uint16_t, std::less<>> numbers_;  ///< of the participants
  std::uint64_t newest_ = 0;
  bool ended_ = false;
};

/// Why a recording cannot be read any further.
enum class RecordingFault {
  no_recording,   ///< the file does not begin like a recording
  other_version,  ///< a newer program wrote it
  damaged,        ///< a record has wrong bytes
};

/// Decodes a recording from pieces of any size. Its memory does not grow with the recording. Never throws.
class RecordingDecoder {
 public:
  void feed(std::span<const std::uint8_t> bytes);
  /// The next record. Returns nothing when more bytes are needed or there is a fault(), which is permanent.
  std::optional<Record> next();
  std::optional<RecordingFault> fault() const { return fault_; }
  /// Number of bytes from the beginning of the file that were read, whole records only.
  std::uint64_t good() const { return good_; }
  /// Whether the last record was a RecordingEnd.
  bool ended() const { return ended_; }

 private:
  bool take_head();
  std::optional<Record> fail();
  std::optional<Record> read_body(std::uint8_t kind, std::span<const std::uint8_t> body, bool& valid);
  std::optional<Record> read_message(std::uint64_t at, std::span<const std::uint8_t> rest, bool& valid);
  bool add_participant(std::span<const std::uint8_t> body);

  std::vector<std::uint8_t> buffer_;
  std::size_t used_ = 0;  ///< bytes of the buffer
  std::uint64_t good_ = 0;
  std::uint64_t newest_ = 0;
  std::vector<std::string> participants_;
  bool has_head_ = false;
  bool started_ = false;
  bool ended_ = false;
  std::optional<RecordingFault> fault_;
};

}  // namespace telemime::meeting
