// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/participant_replay.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "meeting/protocol/messages.h"
#include "meeting/protocol/pose_frame.h"

namespace telemime::meeting {
namespace {

using Json = nlohmann::ordered_json;

// What readers take (docs/room-page.md).
constexpr std::size_t kLongestChat = 2048;
constexpr int kDeepest = 8;
// A little less than a frame of 30 a second: frames that come a little early are not worth a gap.
constexpr double kClosest = 1e6 / 31.0;
// Where a frame has them (docs/room-protocol.md).
constexpr std::size_t kSessionPlace = 2;
constexpr std::size_t kSequencePlace = 4;
constexpr std::size_t kCapturedPlace = 8;

void patch(std::string& bytes, std::size_t place, std::uint64_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    bytes[place + i] = static_cast<char>(value >> (8 * i));
  }
}

/// The JSON object of this text; null when there is none. What was read can be written.
Json read_object(std::string_view text) {
  Json json = Json::parse(
      text, [](int depth, Json::parse_event_t, Json&) { return depth <= kDeepest; },
      /*allow_exceptions=*/false);
  return json.is_object() ? json : Json();
}

std::optional<std::uint32_t> epoch_of(const Json& json) {
  const auto found = json.find("epoch");
  if (found == json.end() || !found->is_number_unsigned() || found->get<std::uint64_t>() > UINT32_MAX) {
    return std::nullopt;
  }
  return found->get<std::uint32_t>();
}

constexpr std::uint16_t after(std::uint16_t session) {
  return session == UINT16_MAX ? std::uint16_t{1} : static_cast<std::uint16_t>(session + 1);
}

}  // namespace

std::optional<std::uint32_t> epoch_of_meeting(std::string_view payload) {
  const Json json = read_object(payload);
  return json.is_null() ? std::nullopt : epoch_of(json);
}

std::optional<std::string> page_with_epoch(std::string_view payload, std::uint32_t epoch) {
  Json json = read_object(payload);
  if (json.is_null() || !epoch_of(json)) {
    return std::nullopt;
  }
  json["epoch"] = epoch;
  std::string text = json.dump();
  return text.size() <= kLongestPayload ? std::optional(std::move(text)) : std::nullopt;
}

ParticipantReplay::ParticipantReplay(double speed, std::uint16_t session, std::uint64_t clock)
    : speed_(speed), session_(session), clock_(clock), chat_shift_(session) {}

std::optional<ReplayStep> ParticipantReplay::step(const RecordedMessage& message) {
  switch (message.topic.kind) {
    case TopicKind::pose:
      return pose(message);
    case TopicKind::state:
      return state(message);
    case TopicKind::presence:
      return presence(message);
    case TopicKind::chat:
      return chat(message);
    case TopicKind::board:
      return board(message);
    case TopicKind::meeting:
      break;
  }
  return std::nullopt;
}

// Whether this session is the one that is followed. A new one takes its place; one that was followed before
// does not come back, as readers have it.
bool ParticipantReplay::follow(std::uint16_t recorded) {
  if (recorded_ == recorded) {
    return true;
  }
  if (past_.contains(recorded)) {
    return false;
  }
  if (recorded_) {
    past_.insert(*recorded_);
    session_ = after(session_);
  }
  recorded_ = recorded;
  sequence_.reset();
  next_sequence_ = 0;
  return true;
}

std::uint64_t ParticipantReplay::captured_of(std::uint64_t at, std::uint64_t recorded) {
  const auto scaled = [this](std::uint64_t us) {
    return speed_ == 1.0 ? us : static_cast<std::uint64_t>(std::llround(static_cast<double>(us) / speed_));
  };
  if (!sequence_) {
    first_captured_ = recorded;
    first_clock_ = clock_ + scaled(at);
    last_clock_ = first_clock_;
    return first_clock_;
  }
  return last_clock_ = std::max(last_clock_ + 1, first_clock_ + scaled(recorded - first_captured_));
}

std::optional<ReplayStep> ParticipantReplay::pose(const RecordedMessage& message) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(message.payload.data());
  const auto frame = decode_pose_frame({bytes, message.payload.size()});
  if (!frame || !follow(frame->session)) {
    return std::nullopt;
  }
  const bool news = !sequence_ || (frame->sequence > *sequence_ && frame->captured > captured_);
  // No clock that counts microseconds from a computer's start comes as far; sums stay in range.
  if (!news || frame->captured >= kTimeEnd) {
    return std::nullopt;
  }
  const double now = static_cast<double>(message.at) / speed_;
  if (speed_ > 1.0 && last_at_ && now - *last_at_ < kClosest) {
    return std::nullopt;
  }
  last_at_ = now;
  ReplayStep step{TopicKind::pose, 0, session_, true, message.payload};
  patch(step.payload, kSessionPlace, session_, 2);
  patch(step.payload, kSequencePlace, next_sequence_++, 4);
  patch(step.payload, kCapturedPlace, captured_of(message.at, frame->captured), 8);
  sequence_ = frame->sequence;
  captured_ = frame->captured;
  return step;
}

std::optional<ReplayStep> ParticipantReplay::state(const RecordedMessage& message) {
  if (message.payload.empty()) {
    return ReplayStep{TopicKind::state, 0, session_, false, ""};
  }
  const auto state = read_state(message.payload);
  if (!state || !follow(state->session)) {
    return std::nullopt;
  }
  Json json = read_object(message.payload);
  json["session"] = session_;
  std::string text = json.dump();
  if (text.size() > kLongestState) {
    return std::nullopt;
  }
  return ReplayStep{TopicKind::state, 0, session_, true, std::move(text)};
}

std::optional<ReplayStep> ParticipantReplay::presence(const RecordedMessage& message) {
  const ReplayStep gone{TopicKind::presence, 0, session_, false, ""};
  if (message.payload.empty()) {
    return gone;
  }
  const auto presence = read_presence(message.payload);
  if (!presence) {
    return std::nullopt;
  }
  if (!presence->here) {
    return recorded_ == presence->session ? std::optional(gone) : std::nullopt;
  }
  if (!follow(presence->session)) {
    return std::nullopt;
  }
  return ReplayStep{TopicKind::presence, 0, session_, true, ""};
}

// Readers show each id once: it gets another first number, so that it is a new one in each replay, and what
// was said twice under one id stays so.
std::optional<ReplayStep> ParticipantReplay::chat(const RecordedMessage& message) const {
  Json json = message.payload.size() <= kLongestChat ? read_object(message.payload) : Json();
  const auto found = json.find("id");
  if (json.is_null() || found == json.end() || !found->is_string()) {
    return std::nullopt;
  }
  const auto& id = found->get_ref<const std::string&>();
  unsigned number = 0;
  const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), number);
  if (error != std::errc() || number < 1 || number > UINT16_MAX) {
    return std::nullopt;
  }
  const std::string rest(end, id.data() + id.size());
  json["id"] = std::to_string(1 + (number - 1 + chat_shift_) % UINT16_MAX) + rest;
  return ReplayStep{TopicKind::chat, 0, session_, true, json.dump()};
}

std::optional<ReplayStep> ParticipantReplay::board(const RecordedMessage& message) const {
  ReplayStep step{TopicKind::board, message.topic.page, session_, true, message.payload};
  if (!message.payload.empty()) {
    const auto epoch = epoch_of_meeting(message.payload);
    if (!epoch || (epoch_ && *epoch != *epoch_)) {
      return std::nullopt;
    }
  }
  return step;
}

}  // namespace telemime::meeting
