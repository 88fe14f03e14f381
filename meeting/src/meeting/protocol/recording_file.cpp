// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/recording_file.h"

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <utility>

#include "meeting/protocol/outcome.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

using Bytes = std::span<const std::uint8_t>;

// Reveals a transfer that changes line ends or stops at control-Z, as the signature of PNG does.
constexpr std::string_view kMagic = "TROOM\r\n\x1a";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kRecordHead = 7;   // kind, size, checksum
constexpr std::size_t kMessageHead = 4;  // what, page, participant; behind the time
constexpr std::size_t kTime = 8;
constexpr std::size_t kLongestReason = 1024;
constexpr std::size_t kLongestBegan = 64;
constexpr std::uint16_t kNobody = 0xffff;

// Letters, so that a dump of the file is readable.
constexpr std::uint8_t kStart = 'S';
constexpr std::uint8_t kName = 'N';
constexpr std::uint8_t kMessage = 'M';
constexpr std::uint8_t kLost = 'L';
constexpr std::uint8_t kBack = 'B';
constexpr std::uint8_t kDropped = 'D';
constexpr std::uint8_t kEnd = 'E';

constexpr std::array<TopicKind, 6> kKinds = {TopicKind::pose, TopicKind::state, TopicKind::presence,
                                             TopicKind::chat, TopicKind::board, TopicKind::meeting};

Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string text_of(Bytes bytes) {
  return {bytes.begin(), bytes.end()};
}

void put(std::string& out, std::uint64_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    out += static_cast<char>(value >> (8 * i));
  }
}

std::uint64_t number_at(Bytes bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value |= static_cast<std::uint64_t>(bytes[at + i]) << (8 * i);
  }
  return value;
}

std::uint32_t checksum(Bytes kind_and_size, Bytes body) {
  boost::crc_32_type crc;
  crc.process_bytes(kind_and_size.data(), kind_and_size.size());
  crc.process_bytes(body.data(), body.size());
  return crc.checksum();
}

std::string record_of(std::uint8_t kind, const std::string& body) {
  std::string out(1, static_cast<char>(kind));
  put(out, body.size(), 2);
  put(out, checksum(bytes_of(out), bytes_of(body)), 4);
  return out + body;
}

std::string timed(std::uint64_t at) {
  std::string body;
  put(body, at, kTime);
  return body;
}

bool is_start(const RecordingStart& start) {
  return is_topic_segment(start.meeting.tenant) && is_topic_segment(start.meeting.meeting) &&
         start.began.size() <= kLongestBegan &&
         std::all_of(start.began.begin(), start.began.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

[[noreturn]] void refuse(const std::string& why) {
  throw Error(ErrorKind::usage, "this cannot be recorded: " + why);
}

std::optional<Record> read_start(Bytes body) {
  const auto start = read_if_valid(text_of(body), kMessageSource, [](const JsonField& json) {
    return RecordingStart{{json["tenant"].text(), json["room"].text()}, json["began"].text()};
  });
  return start && is_start(*start) ? std::optional<Record>(*start) : std::nullopt;
}

}  // namespace

std::uint64_t time_of(const Record& record) {
  return std::visit(
      [](const auto& one) -> std::uint64_t {
        if constexpr (requires { one.at; }) {
          return one.at;
        }
        return 0;
      },
      record);
}

std::string RecordingEncoder::begin(const RecordingStart& start) {
  if (!is_start(start)) {
    refuse("its meeting or its date is invalid");
  }
  std::string out(kMagic);
  put(out, kVersion, 4);
  const nlohmann::json about = {
      {"tenant", start.meeting.tenant}, {"room", start.meeting.meeting}, {"began", start.began}};
  return out + record_of(kStart, about.dump());
}

// Returns nothing when there are too many participants.
std::optional<std::string> RecordingEncoder::message(const RecordedMessage& message) {
  const bool of_meeting = message.topic.kind == TopicKind::meeting;
  const int page = message.topic.kind == TopicKind::board ? message.topic.page : 0;
  if (message.payload.size() > kLongestPayload || page < 0 || page >= kMostBoardPages ||
      (!of_meeting && !is_topic_segment(message.topic.participant))) {
    refuse("a message is too long, or has no participant");
  }
  std::string out;
  std::uint16_t number = kNobody;
  if (!of_meeting) {
    auto found = numbers_.find(message.topic.participant);
    if (found == numbers_.end()) {
      if (numbers_.size() >= kMostRecordedParticipants) {
        return std::nullopt;
      }
      const auto next = static_cast<std::uint16_t>(numbers_.size());
      found = numbers_.emplace(message.topic.participant, next).first;
      // The first message of a participant follows their name.
      std::string name;
      put(name, next, 2);
      out = record_of(kName, name + message.topic.participant);
    }
    number = found->second;
  }
  const auto* const what = std::find(kKinds.begin(), kKinds.end(), message.topic.kind);
  std::string body = timed(message.at);
  put(body, static_cast<std::uint64_t>(what - kKinds.begin()), 1);
  put(body, static_cast<std::uint64_t>(page), 1);
  put(body, number, 2);
  return out + record_of(kMessage, body + message.payload);
}

std::optional<std::string> RecordingEncoder::encode(const Record& record) {
  const std::uint64_t at = time_of(record);
  if (ended_ || std::holds_alternative<RecordingStart>(record)) {
    refuse("a recording has one start and one end");
  }
  if (at < newest_ || at >= kTimeEnd) {
    refuse("its time is before the previous one, or out of range");
  }
  std::string body = timed(at);
  std::optional<std::string> out;
  if (const auto* const sent = std::get_if<RecordedMessage>(&record)) {
    out = message(*sent);
  } else if (const auto* const lost = std::get_if<ConnectionLost>(&record)) {
    out = record_of(kLost, body + lost->reason.substr(0, kLongestReason));
  } else if (const auto* const dropped = std::get_if<MessagesDropped>(&record)) {
    put(body, dropped->count, 4);
    out = record_of(kDropped, body);
  } else {
    ended_ = std::holds_alternative<RecordingEnd>(record);
    out = record_of(ended_ ? kEnd : kBack, body);
  }
  newest_ = out ? at : newest_;
  return out;
}

void RecordingDecoder::feed(Bytes bytes) {
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(std::exchange(used_, 0)));
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

std::optional<Record> RecordingDecoder::fail() {
  fault_ = RecordingFault::damaged;
  return std::nullopt;
}

// Reads the head of the file. Returns false when bytes are missing or wrong.
bool RecordingDecoder::take_head() {
  const Bytes seen = Bytes(buffer_).subspan(used_);
  const std::size_t compared = std::min(seen.size(), kMagic.size());
  if (text_of(seen.first(compared)) != kMagic.substr(0, compared)) {
    fault_ = RecordingFault::no_recording;
    return false;
  }
  if (seen.size() < kRecordingHead) {
    return false;
  }
  if (number_at(seen, kMagic.size(), 4) != kVersion) {
    fault_ = RecordingFault::other_version;
    return false;
  }
  used_ += kRecordingHead;
  good_ += kRecordingHead;
  has_head_ = true;
  return true;
}

std::optional<Record> RecordingDecoder::next() {
  while (!fault_ && (has_head_ || take_head())) {
    const Bytes seen = Bytes(buffer_).subspan(used_);
    if (ended_ && !seen.empty()) {
      return fail();
    }
    if (seen.size() < kRecordHead) {
      return std::nullopt;
    }
    const auto size = static_cast<std::size_t>(number_at(seen, 1, 2));
    if (seen.size() < kRecordHead + size) {
      return std::nullopt;
    }
    const Bytes body = seen.subspan(kRecordHead, size);
    if (number_at(seen, 3, 4) != checksum(seen.first(3), body)) {
      return fail();
    }
    bool valid = true;
    auto record = read_body(seen[0], body, valid);
    if (!valid) {
      return fail();
    }
    used_ += kRecordHead + size;
    good_ += kRecordHead + size;
    if (record) {
      return record;
    }
  }
  return std::nullopt;
}

// Returns nothing for records that are not for the reader: names, and kinds that a later version may write.
std::optional<Record> RecordingDecoder::read_body(std::uint8_t kind, Bytes body, bool& valid) {
  if (!started_) {
    auto start = kind == kStart ? read_start(body) : std::nullopt;
    valid = started_ = start.has_value();
    return start;
  }
  if (kind == kName) {
    valid = add_participant(body);
    return std::nullopt;
  }
  constexpr std::string_view kTimed = "MLBDE";
  if (kTimed.find(static_cast<char>(kind)) == std::string_view::npos) {
    valid = kind != kStart;
    return std::nullopt;
  }
  const std::uint64_t at = body.size() < kTime ? kTimeEnd : number_at(body, 0, kTime);
  valid = at >= newest_ && at < kTimeEnd;
  if (!valid) {
    return std::nullopt;
  }
  newest_ = at;
  const Bytes rest = body.subspan(kTime);
  switch (kind) {
    case kMessage:
      return read_message(at, rest, valid);
    case kLost:
      valid = rest.size() <= kLongestReason;
      return ConnectionLost{at, text_of(rest)};
    case kBack:
      valid = rest.empty();
      return ConnectionRestored{at};
    case kDropped:
      valid = rest.size() == 4;
      return MessagesDropped{at, valid ? static_cast<std::uint32_t>(number_at(rest, 0, 4)) : 0};
    default:
      valid = rest.empty();
      ended_ = valid;
      return RecordingEnd{at};
  }
}

std::optional<Record> RecordingDecoder::read_message(std::uint64_t at, Bytes rest, bool& valid) {
  valid =
      rest.size() >= kMessageHead && rest.size() - kMessageHead <= kLongestPayload && rest[0] < kKinds.size();
  if (!valid) {
    return std::nullopt;
  }
  RecordedMessage message;
  message.at = at;
  message.topic.kind = kKinds[rest[0]];
  message.topic.page = rest[1];
  const auto number = static_cast<std::size_t>(number_at(rest, 2, 2));
  const bool of_meeting = message.topic.kind == TopicKind::meeting;
  valid = (of_meeting ? number == kNobody : number < participants_.size()) &&
          message.topic.page < (message.topic.kind == TopicKind::board ? kMostBoardPages : 1);
  if (!valid) {
    return std::nullopt;
  }
  message.topic.participant = of_meeting ? "" : participants_[number];
  message.payload = text_of(rest.subspan(kMessageHead));
  return message;
}

bool RecordingDecoder::add_participant(Bytes body) {
  if (body.size() < 2 || number_at(body, 0, 2) != participants_.size() ||
      participants_.size() >= kMostRecordedParticipants) {
    return false;
  }
  std::string name = text_of(body.subspan(2));
  if (!is_topic_segment(name) ||
      std::find(participants_.begin(), participants_.end(), name) != participants_.end()) {
    return false;
  }
  participants_.push_back(std::move(name));
  return true;
}

}  // namespace telemime::meeting
