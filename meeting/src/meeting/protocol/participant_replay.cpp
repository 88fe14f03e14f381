// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/participant_replay.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "meeting/protocol/meeting_info.h"
#include "meeting/protocol/messages.h"
#include "meeting/protocol/pose_detail.h"
#include "meeting/protocol/pose_frame.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kLongestChat = 2048;  // bytes, as readers accept (meeting/docs/protocol.md)
// us. Slightly less than the frame time at 30 per second, so that a frame that comes a little early is kept.
constexpr double kClosest = 1e6 / 31.0;
// Offsets in a pose frame (meeting/docs/protocol.md); a detail has the first two.
constexpr std::size_t kSessionPlace = 2;
constexpr std::size_t kSequencePlace = 4;
constexpr std::size_t kCapturedPlace = 8;

void patch(std::string& bytes, std::size_t place, std::uint64_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    bytes[place + i] = static_cast<char>(value >> (8 * i));
  }
}

constexpr std::uint16_t after(std::uint16_t session) {
  return session == UINT16_MAX ? std::uint16_t{1} : static_cast<std::uint16_t>(session + 1);
}

}  // namespace

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

// Whether messages of this session are replayed. A new session replaces the previous one, as for readers:
// what an earlier one says while the new one begins is left over. Later it has returned: the page of somebody
// whose tracker has ended.
bool ParticipantReplay::follow(std::uint16_t recorded, std::uint64_t at) {
  constexpr std::uint64_t kLeftovers = 1'000'000;  // us
  if (recorded_ == recorded) {
    left_ = false;
    return true;
  }
  const auto earlier = replaced_.find(recorded);
  if (earlier != replaced_.end() && !left_ && at < earlier->second + kLeftovers) {
    return false;
  }
  if (recorded_) {
    replaced_[*recorded_] = at;
    session_ = after(session_);
    if (sequence_) {
      ended_.insert(*recorded_);
    }
  }
  recorded_ = recorded;
  left_ = false;
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
  ReplayStep step{TopicKind::pose, 0, session_, true, message.payload};
  if (is_pose_detail(message.payload)) {
    const auto detail = decode_pose_detail({bytes, message.payload.size()});
    // Of the frame that was replayed last.
    if (!detail || recorded_ != detail->session || sequence_ != detail->sequence) {
      return std::nullopt;
    }
    patch(step.payload, kSessionPlace, session_, 2);
    patch(step.payload, kSequencePlace, next_sequence_ - 1, 4);
    return step;
  }
  const auto frame = decode_pose_frame({bytes, message.payload.size()});
  const bool ended = frame && recorded_ != frame->session && ended_.contains(frame->session);
  if (!frame || ended || !follow(frame->session, message.at)) {
    return std::nullopt;
  }
  const bool newer = !sequence_ || (frame->sequence > *sequence_ && frame->captured > captured_);
  // Real clocks do not reach kTimeEnd; below it the sums stay in range.
  if (!newer || frame->captured >= kTimeEnd) {
    return std::nullopt;
  }
  const double now = static_cast<double>(message.at) / speed_;
  if (speed_ > 1.0 && last_at_ && now - *last_at_ < kClosest) {
    return std::nullopt;
  }
  last_at_ = now;
  step.session = session_;
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
  if (!state || !follow(state->session, message.at)) {
    return std::nullopt;
  }
  nlohmann::json json = parse_json(message.payload, kMessageSource);
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
    left_ = left_ || recorded_ == presence->session;
    return recorded_ == presence->session ? std::optional(gone) : std::nullopt;
  }
  if (!follow(presence->session, message.at)) {
    return std::nullopt;
  }
  return ReplayStep{TopicKind::presence, 0, session_, true, ""};
}

// Readers show each id once. A new first number makes the id new in each replay; equal ids stay equal.
std::optional<ReplayStep> ParticipantReplay::chat(const RecordedMessage& message) const {
  if (message.payload.size() > kLongestChat) {
    return std::nullopt;
  }
  return read_if_valid(message.payload, kMessageSource, [this](const JsonField& chat) {
    const std::string id = chat["id"].text();
    unsigned number = 0;
    const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), number);
    if (error != std::errc() || number < 1 || number > UINT16_MAX) {
      chat["id"].fail("does not begin with a session");
    }
    nlohmann::json json = chat.value();
    json["id"] =
        std::to_string(1 + (number - 1 + chat_shift_) % UINT16_MAX) + std::string(end, id.data() + id.size());
    return ReplayStep{TopicKind::chat, 0, session_, true, json.dump()};
  });
}

std::optional<ReplayStep> ParticipantReplay::board(const RecordedMessage& message) const {
  ReplayStep step{TopicKind::board, message.topic.page, session_, true, message.payload};
  if (!message.payload.empty()) {
    const auto epoch = read_epoch(message.payload);
    if (!epoch || (epoch_ && *epoch != *epoch_)) {
      return std::nullopt;
    }
  }
  return step;
}

}  // namespace telemime::meeting
