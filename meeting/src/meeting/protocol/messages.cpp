// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/messages.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "meeting/protocol/topics.h"
#include "telemime/core/errors.h"
#include "telemime/core/text.h"
#include "telemime/outputs/numbers.h"

namespace telemime::meeting {
namespace {

using Json = nlohmann::ordered_json;  // members keep their order

constexpr int kVersion = 1;
constexpr int kMetreDecimals = 5;
constexpr double kShortest = 0.3;   // m
constexpr double kTallest = 3.0;    // m
constexpr double kFarthest = 10.0;  // m
constexpr std::size_t kLongestUrl = 2048;
constexpr std::size_t kHashDigits = 64;
constexpr std::size_t kMostAttending = 1000;  // the names come from outside, so memory needs a bound
constexpr std::string_view kHttps = "https://";

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

std::uint16_t session_of(const JsonField& message) {
  return static_cast<std::uint16_t>(message["session"].integer(1, UINT16_MAX));
}

ParticipantKind kind_of(const JsonField& kind) {
  const std::string text = kind.text();
  if (text != "tracker" && text != "browser") {
    kind.fail("is neither tracker nor browser");
  }
  return text == "tracker" ? ParticipantKind::tracker : ParticipantKind::browser;
}

std::variant<std::monostate, AvatarByLook, AvatarFile> avatar_of(const JsonField& avatar) {
  if (!avatar.has("url")) {
    const std::string look = avatar["look"].text();
    if (!is_topic_segment(look)) {
      avatar.fail("has a look that is not a name");
    }
    return AvatarByLook{look};
  }
  const AvatarFile file{avatar["url"].text(), avatar["sha256"].text(),
                        avatar["bytes"].integer(1, kLargestAvatar)};
  if (!is_file(file)) {
    avatar.fail("has no https address, hash or size");
  }
  return file;
}

void read_bones(const JsonField& bones, ParticipantState& state) {
  if (!bones.value().is_object()) {
    bones.fail("must be a JSON object");
  }
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    if (!bones.has(kHumanBoneNames[bone])) {
      continue;
    }
    const JsonField place = bones[kHumanBoneNames[bone]];
    const auto numbers = place.numbers<3>();
    state.bones[bone] = Eigen::Vector3d(numbers.data());
    if (!is_position(*state.bones[bone])) {
      place.fail("is not within 10 m");
    }
  }
}

/// A number of a message that `valid` accepts; anything else counts as missing.
std::optional<double> optional_number(const JsonField& message, const char* name, bool (*valid)(double)) {
  const auto number = message.optional(name, [](const JsonField& f) { return f.number(); });
  return number && valid(*number) ? number : std::nullopt;
}

/// Whether an object has the member, and it is not null.
bool has_value(const JsonField& object, const char* name) {
  return object.has(name) && !object[name].value().is_null();
}

/// What `parse_message` gives for a message of at most `longest` bytes, or the reason why it is invalid.
template <class Message, class Parse>
Outcome<Message, MessageFault> read(std::string_view bytes, std::size_t longest, const Parse& parse_message) {
  if (bytes.empty() || bytes.size() > longest) {
    return MessageFault{"it does not have 1 to " + std::to_string(longest) + " bytes"};
  }
  try {
    const nlohmann::json json = parse_json(bytes, kMessageSource);
    const JsonField message(json, kMessageSource);
    message["v"].integer(kVersion, kVersion);
    return parse_message(message);
  } catch (const Error& fault) {
    return MessageFault{fault.what()};
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
  return read<ParticipantState>(bytes, kLongestState, [](const JsonField& message) {
    ParticipantState state;
    state.session = session_of(message);
    state.kind = kind_of(message["kind"]);
    state.name = message["name"].text();
    if (!is_participant_name(state.name)) {
      message["name"].fail("is not 1 to 40 characters without control characters");
    }
    const auto seat =
        message.optional("seat", [](const JsonField& f) { return f.integer(0, kMostSeats - 1); });
    state.seat = seat ? std::optional(static_cast<int>(*seat)) : std::nullopt;
    if (has_value(message, "avatar")) {
      state.avatar = avatar_of(message["avatar"]);
    }
    state.stature = optional_number(message, "stature", is_stature);
    if (has_value(message, "bones")) {
      read_bones(message["bones"], state);
    }
    return state;
  });
}

Outcome<ParticipantPresence, MessageFault> read_presence(std::string_view bytes) {
  return read<ParticipantPresence>(bytes, kLongestPresence, [](const JsonField& message) {
    return ParticipantPresence{message["here"].boolean(), session_of(message),
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
