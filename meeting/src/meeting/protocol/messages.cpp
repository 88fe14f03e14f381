// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/messages.h"

#include <algorithm>

#include "meeting/protocol/json.h"
#include "meeting/protocol/topics.h"
#include "telemime/core/errors.h"
#include "telemime/core/text.h"
#include "telemime/outputs/numbers.h"

namespace telemime::meeting {
namespace {

constexpr int kVersion = 1;
constexpr int kMetreDecimals = 5;
constexpr double kShortest = 0.3;   // m
constexpr double kTallest = 3.0;    // m
constexpr double kFarthest = 10.0;  // m
constexpr std::size_t kLongestUrl = 2048;
constexpr std::size_t kHashDigits = 64;
constexpr std::size_t kMostAttending = 1000;  // the names come from outside, so memory needs a bound
constexpr std::string_view kHttps = "https://";

[[noreturn]] void reject(const std::string& reason) {
  throw MessageFault{reason};  // caught by read()
}

bool is_hash(std::string_view text) {
  return text.size() == kHashDigits && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_file_url(std::string_view url) {
  if (url.size() > kLongestUrl || !url.starts_with(kHttps) ||
      !std::all_of(url.begin(), url.end(), [](char c) { return c > ' ' && c < '\x7f'; })) {
    return false;
  }
  url.remove_prefix(kHttps.size());
  const std::string_view host = url.substr(0, url.find_first_of("/?#\\"));
  return !host.empty() && host.find('@') == std::string_view::npos;
}

bool is_file(const AvatarFile& file) {
  return is_file_url(file.url) && is_hash(file.sha256) && file.bytes >= 1 && file.bytes <= kLargestAvatar;
}

bool is_promise(double seconds) {
  return seconds >= kShortestPromise && seconds <= kLongestPromise;
}

bool is_position(const Eigen::Vector3d& position) {
  return position.allFinite() && position.cwiseAbs().maxCoeff() <= kFarthest;
}

Json parse(std::string_view bytes, std::size_t longest) {
  if (bytes.empty() || bytes.size() > longest) {
    reject("it does not have 1 to " + std::to_string(longest) + " bytes");
  }
  Json message = parse_object(bytes);
  if (message.is_null()) {
    reject("it is not a JSON object");
  }
  if (!whole_member(message, "v", kVersion, kVersion)) {
    reject("it has another version");
  }
  return message;
}

std::uint16_t session_of(const Json& message) {
  const auto session = whole_member(message, "session", 1, UINT16_MAX);
  if (!session) {
    reject("session is not a number from 1 to 65535");
  }
  return static_cast<std::uint16_t>(*session);
}

ParticipantKind kind_of(const Json& message) {
  const std::string kind = text_member(message, "kind");
  if (kind != "tracker" && kind != "browser") {
    reject("kind is neither tracker nor browser");
  }
  return kind == "tracker" ? ParticipantKind::tracker : ParticipantKind::browser;
}

std::variant<std::monostate, AvatarByLook, AvatarFile> avatar_of(const Json& message) {
  const Json& avatar = member(message, "avatar");
  if (avatar.is_null()) {
    return {};
  }
  if (!avatar.is_object()) {
    reject("avatar is not an object");
  }
  if (!avatar.contains("url")) {
    const std::string look = text_member(avatar, "look");
    if (!is_topic_segment(look)) {
      reject("the look of the avatar is not a name");
    }
    return AvatarByLook{look};
  }
  const AvatarFile file{text_member(avatar, "url"), text_member(avatar, "sha256"),
                        whole_member(avatar, "bytes", 1, kLargestAvatar).value_or(0)};
  if (!is_file(file)) {
    reject("the avatar file has no https address, hash or size");
  }
  return file;
}

void read_bones(const Json& message, ParticipantState& state) {
  const Json& bones = member(message, "bones");
  if (!bones.is_null() && !bones.is_object()) {
    reject("bones is not an object");
  }
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    const auto found = bones.find(std::string(kHumanBoneNames[bone]));
    if (found == bones.end()) {
      continue;
    }
    const bool three = found->is_array() && found->size() == 3 &&
                       std::all_of(found->begin(), found->end(), [](const Json& v) { return v.is_number(); });
    Eigen::Vector3d position = Eigen::Vector3d::Constant(2.0 * kFarthest);
    for (std::size_t axis = 0; axis < 3 && three; ++axis) {
      position[static_cast<Eigen::Index>(axis)] = (*found)[axis].get<double>();
    }
    if (!is_position(position)) {
      reject("the position of a bone is not three numbers within 10 m");
    }
    state.bones[bone] = position;
  }
}

/// A number of a message that `valid` accepts; anything else counts as missing.
std::optional<double> optional_number(const Json& message, const char* name, bool (*valid)(double)) {
  const Json& value = member(message, name);
  return value.is_number() && valid(value.get<double>()) ? std::optional(value.get<double>()) : std::nullopt;
}

/// The result of `parse_message`, or the fault that it throws.
template <class Message, class Parse>
Outcome<Message, MessageFault> read(const Parse& parse_message) {
  try {
    return parse_message();
  } catch (const MessageFault& fault) {
    return fault;
  }
}

Json avatar_json(const ParticipantState& state) {
  if (const auto* const look = std::get_if<AvatarByLook>(&state.avatar)) {
    return {{"look", look->look}};
  }
  if (const auto* const file = std::get_if<AvatarFile>(&state.avatar)) {
    return {{"url", file->url}, {"sha256", file->sha256}, {"bytes", file->bytes}};
  }
  return nullptr;
}

Json bones_json(const ParticipantState& state) {
  Json bones = Json::object();
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    if (const auto& position = state.bones[bone]) {
      bones[std::string(kHumanBoneNames[bone])] = {rounded(position->x(), kMetreDecimals),
                                                   rounded(position->y(), kMetreDecimals),
                                                   rounded(position->z(), kMetreDecimals)};
    }
  }
  return bones;
}

void require(bool holds, const std::string& what) {
  if (!holds) {
    throw Error(ErrorKind::usage, "this message of a participant cannot be written: " + what);
  }
}

void require_writable(const ParticipantState& state) {
  require(state.session != 0, "the session is 0");
  require(is_participant_name(state.name), "the name is invalid");
  require(!state.seat || (*state.seat >= 0 && *state.seat < kMostSeats), "the seat is invalid");
  require(!state.stature || is_stature(*state.stature), "the stature is invalid");
  const auto* const look = std::get_if<AvatarByLook>(&state.avatar);
  require(look == nullptr || is_topic_segment(look->look), "the look of the avatar is invalid");
  const auto* const file = std::get_if<AvatarFile>(&state.avatar);
  require(file == nullptr || is_file(*file), "the avatar file is invalid");
  for (const auto& position : state.bones) {
    require(!position || is_position(*position), "the position of a bone is invalid");
  }
}

}  // namespace

bool is_participant_name(std::string_view text) {
  const auto length = text.size() <= 4 * kLongestName ? printable_length(text) : std::nullopt;
  return length && *length >= 1 && *length <= kLongestName;
}

bool is_stature(double metres) {
  return metres >= kShortest && metres <= kTallest;
}

std::string write_state(const ParticipantState& state) {
  require_writable(state);
  Json message = {{"v", kVersion},
                  {"session", state.session},
                  {"kind", state.kind == ParticipantKind::tracker ? "tracker" : "browser"},
                  {"name", state.name},
                  {"seat", nullptr},
                  {"avatar", avatar_json(state)}};
  if (state.seat) {
    message["seat"] = *state.seat;
  }
  if (state.stature) {
    message["stature"] = rounded(*state.stature, kMetreDecimals);
  }
  if (Json bones = bones_json(state); !bones.empty()) {
    message["bones"] = std::move(bones);
  }
  std::string text = message.dump();
  require(text.size() <= kLongestState, "it is too long");
  return text;
}

std::string write_presence(const ParticipantPresence& presence) {
  require(presence.session != 0, "the session is 0");
  Json message{{"v", kVersion}, {"here", presence.here}, {"session", presence.session}};
  if (presence.every) {
    require(is_promise(*presence.every), "the promise is out of range");
    message["every"] = *presence.every;
  }
  return message.dump();
}

Outcome<ParticipantState, MessageFault> read_state(std::string_view bytes) {
  return read<ParticipantState>([&] {
    const Json message = parse(bytes, kLongestState);
    ParticipantState state;
    state.session = session_of(message);
    state.kind = kind_of(message);
    state.name = text_member(message, "name");
    if (!is_participant_name(state.name)) {
      reject("name is not 1 to 40 characters without control characters");
    }
    if (const auto seat = whole_member(message, "seat", 0, kMostSeats - 1)) {
      state.seat = static_cast<int>(*seat);
    }
    state.avatar = avatar_of(message);
    state.stature = optional_number(message, "stature", is_stature);
    read_bones(message, state);
    return state;
  });
}

Outcome<ParticipantPresence, MessageFault> read_presence(std::string_view bytes) {
  return read<ParticipantPresence>([&] {
    const Json message = parse(bytes, kLongestPresence);
    const Json& here = member(message, "here");
    if (!here.is_boolean()) {
      reject("here is neither true nor false");
    }
    return ParticipantPresence{here.get<bool>(), session_of(message),
                               optional_number(message, "every", is_promise)};
  });
}

void Attendance::update(const std::string& participant, std::string_view message) {
  if (message.empty()) {
    sessions_.erase(participant);
    return;
  }
  const auto presence = read_presence(message);
  if (!presence) {
    return;
  }
  const auto found = sessions_.find(participant);
  if (found == sessions_.end()) {
    if (presence->here && sessions_.size() < kMostAttending) {
      sessions_.emplace(participant, presence->session);
    }
  } else if (presence->here) {
    found->second = presence->session;
  } else if (found->second == presence->session) {
    sessions_.erase(found);
  }
}

}  // namespace telemime::meeting
