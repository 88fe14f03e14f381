// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "meeting/protocol/topics.h"

namespace telemime::meeting {

/// Bytes of a message's payload in a recording at most: no message of a room is longer.
inline constexpr std::size_t kLongestPayload = 16384;
/// Participants of a recording at most: their names come from outside, and memory has a bound.
inline constexpr std::size_t kMostRecordedParticipants = 1000;
/// Times in a recording are less, us (285 years): differences stay exact as floating point numbers.
inline constexpr std::uint64_t kTimeEnd = std::uint64_t{1} << 53U;
/// The head of a recording's file: eight fixed bytes and the version.
inline constexpr std::size_t kRecordingHead = 12;

/// The first record: which room, and when.
struct RecordingStart {
  MeetingAddress meeting;
  std::string began;  ///< by the calendar, "2026-11-22T15:30:00Z"; printable ASCII, at most 64 bytes
};
/// Somebody said something. `at` of this and of the others: us since the recording began, by a clock that
/// never goes back.
struct RecordedMessage {
  std::uint64_t at = 0;
  Topic topic;
  std::string payload;
};
/// From here on nothing could be heard; until ConnectionRestored.
struct ConnectionLost {
  std::uint64_t at = 0;
  std::string words;  ///< why, at most 1024 bytes
};
struct ConnectionRestored {
  std::uint64_t at = 0;
};
/// So many messages were heard before this moment and are missing, as the disk was too slow.
struct MessagesDropped {
  std::uint64_t at = 0;
  std::uint32_t count = 0;
};
/// The recording ended in order. Nothing comes behind it.
struct RecordingEnd {
  std::uint64_t at = 0;
};
using Record = std::variant<RecordingStart, RecordedMessage, ConnectionLost, ConnectionRestored,
                            MessagesDropped, RecordingEnd>;

/// When it was, us; 0 for the start.
std::uint64_t time_of(const Record& record);

/// Writes a recording (docs/room-recording.md), a record at a time.
class RecordingEncoder {
 public:
  /// The file's head and its first record. Throws Error(usage) when the room is none or `began` breaks its
  /// rule.
  static std::string begin(const RecordingStart& start);
  /// The bytes of the next record; nothing for a message of one participant too many. Throws Error(usage) for
  /// a second start, what comes behind the end, a time that is out of range or before the one of the record
  /// before, and what is too long.
  std::optional<std::string> encode(const Record& record);

 private:
  std::optional<std::string> message(const RecordedMessage& message);

  std::map<std::string, std::uint16_t, std::less<>> numbers_;  ///< of the participants
  std::uint64_t newest_ = 0;
  bool ended_ = false;
};

/// Why the bytes cannot be read from here on.
enum class RecordingFault {
  no_recording,   ///< the file does not begin as a recording does
  other_version,  ///< of the format: a newer program wrote it
  damaged,        ///< a record whose bytes are not what was written
};

/// Reads a recording from pieces of any size, in memory that does not grow with it. Never throws.
class RecordingDecoder {
 public:
  void feed(std::span<const std::uint8_t> bytes);
  /// The next record. Nothing: more bytes are needed, or there is a fault(), which stays.
  std::optional<Record> next();
  std::optional<RecordingFault> fault() const { return fault_; }
  /// Bytes from the beginning of the file that were read: whole records only.
  std::uint64_t good() const { return good_; }
  /// Whether the last record was a RecordingEnd.
  bool ended() const { return ended_; }

 private:
  bool take_head();
  std::optional<Record> fail();
  std::optional<Record> read_body(std::uint8_t kind, std::span<const std::uint8_t> body, bool& well);
  std::optional<Record> read_message(std::uint64_t at, std::span<const std::uint8_t> rest, bool& well);
  bool add_participant(std::span<const std::uint8_t> body);

  std::vector<std::uint8_t> buffer_;
  std::size_t used_ = 0;  ///< of the buffer
  std::uint64_t good_ = 0;
  std::uint64_t newest_ = 0;
  std::vector<std::string> participants_;
  bool has_head_ = false;
  bool started_ = false;
  bool ended_ = false;
  std::optional<RecordingFault> fault_;
};

}  // namespace telemime::meeting
