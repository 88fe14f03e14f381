// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/messages.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "meeting/protocol/topics.h"
#include "telemime/core/errors.h"
#include "telemime/outputs/numbers.h"

namespace telemime::meeting {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kVersion = 1;
constexpr int kMetreDecimals = 5;
constexpr double kShortest = 0.3;   // m
constexpr double kTallest = 3.0;    // m
constexpr double kFarthest = 10.0;  // m
constexpr std::size_t kLongestUrl = 2048;
constexpr std::size_t kHashDigits = 64;
constexpr int kDeepest = 8;
constexpr std::string_view kHttps = "https://";

/// Thrown by what reads a member, caught by what reads the message.
struct Refused {
  std::string words;
};

[[noreturn]] void refuse(const std::string& words) {
  throw Refused{words};
}

/// The code points of UTF-8 that is known to be valid.
template <class Each>
void for_code_points(std::string_view text, const Each& each) {
  char32_t point = 0;
  bool any = false;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80U) {
      point = point << 6U | (byte & 0x3FU);
      continue;
    }
    if (any) {
      each(point);
    }
    any = true;
    point = byte < 0x80U ? byte : byte < 0xE0U ? byte & 0x1FU : byte < 0xF0U ? byte & 0x0FU : byte & 0x07U;
  }
  if (any) {
    each(point);
  }
}

bool is_utf8(std::string_view text) {
  try {
    static_cast<void>(Json(text).dump());
    return true;
  } catch (const Json::type_error&) {
    return false;
  }
}

bool is_hash(std::string_view text) {
  return text.size() == kHashDigits && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
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

bool is_place(const Eigen::Vector3d& place) {
  return place.allFinite() && place.cwiseAbs().maxCoeff() <= kFarthest;
}

/// A whole number from `least` to `most`, also one that is written like 3.0, as for JavaScript.
std::optional<std::int64_t> whole(const Json& value, std::int64_t least, std::int64_t most) {
  if (!value.is_number()) {
    return std::nullopt;
  }
  const auto number = value.get<double>();
  if (!(number >= static_cast<double>(least) && number <= static_cast<double>(most)) ||
      number != std::floor(number)) {
    return std::nullopt;
  }
  return static_cast<std::int64_t>(number);
}

const Json& member(const Json& message, const char* name) {
  static const Json none;
  const auto found = message.find(name);
  return found == message.end() ? none : *found;
}

Json parse(std::string_view bytes, std::size_t most) {
  if (bytes.empty() || bytes.size() > most) {
    refuse("it has not 1 to " + std::to_string(most) + " bytes");
  }
  bool too_deep = false;
  const auto shallow = [&too_deep](int depth, Json::parse_event_t /*event*/, Json& /*value*/) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  Json message = Json::parse(bytes, shallow, /*allow_exceptions=*/false);
  if (too_deep || !message.is_object()) {
    refuse("it is no JSON object");
  }
  if (whole(member(message, "v"), kVersion, kVersion) != kVersion) {
    refuse("it is of another version");
  }
  return message;
}

std::uint16_t session_of(const Json& message) {
  const auto session = whole(member(message, "session"), 1, UINT16_MAX);
  if (!session) {
    refuse("session is no number from 1 to 65535");
  }
  return static_cast<std::uint16_t>(*session);
}

ParticipantKind kind_of(const Json& message) {
  const Json& kind = member(message, "kind");
  if (kind == "tracker") {
    return ParticipantKind::tracker;
  }
  if (kind == "browser") {
    return ParticipantKind::browser;
  }
  refuse("kind is neither tracker nor browser");
}

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::variant<std::monostate, AvatarByLook, AvatarFile> avatar_of(const Json& message) {
  const Json& avatar = member(message, "avatar");
  if (avatar.is_null()) {
    return {};
  }
  if (!avatar.is_object()) {
    refuse("avatar is no object");
  }
  if (!avatar.contains("url")) {
    const std::string look = text_of(member(avatar, "look"));
    if (!is_topic_segment(look)) {
      refuse("the look of the avatar is no name");
    }
    return AvatarByLook{look};
  }
  const AvatarFile file{text_of(member(avatar, "url")), text_of(member(avatar, "sha256")),
                        whole(member(avatar, "bytes"), 1, kLargestAvatar).value_or(0)};
  if (!is_file(file)) {
    refuse("the file of the avatar has no https address, hash or size");
  }
  return file;
}

void read_bones(const Json& message, ParticipantState& state) {
  const Json& bones = member(message, "bones");
  if (bones.is_null()) {
    return;
  }
  if (!bones.is_object()) {
    refuse("bones is no object");
  }
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    const auto found = bones.find(std::string(kHumanBoneNames[bone]));
    if (found == bones.end()) {
      continue;
    }
    const bool three = found->is_array() && found->size() == 3 &&
                       std::all_of(found->begin(), found->end(), [](const Json& v) { return v.is_number(); });
    const Eigen::Vector3d place =
        three
            ? Eigen::Vector3d((*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>())
            : Eigen::Vector3d::Constant(2.0 * kFarthest);
    if (!is_place(place)) {
      refuse("the place of a bone is not three numbers within 10 m");
    }
    state.bones[bone] = place;
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
    if (const auto& place = state.bones[bone]) {
      bones[std::string(kHumanBoneNames[bone])] = {rounded(place->x(), kMetreDecimals),
                                                   rounded(place->y(), kMetreDecimals),
                                                   rounded(place->z(), kMetreDecimals)};
    }
  }
  return bones;
}

void require(bool holds, const std::string& what) {
  if (!holds) {
    throw Error(ErrorKind::usage, "what a room is told of a participant is not right: " + what);
  }
}

void require_writable(const ParticipantState& state) {
  require(state.session != 0, "the session is 0");
  require(is_participant_name(state.name), "the name");
  require(!state.seat || (*state.seat >= 0 && *state.seat < kMostSeats), "the seat");
  require(!state.stature || is_stature(*state.stature), "the stature");
  const auto* const look = std::get_if<AvatarByLook>(&state.avatar);
  require(look == nullptr || is_topic_segment(look->look), "the look of the avatar");
  const auto* const file = std::get_if<AvatarFile>(&state.avatar);
  require(file == nullptr || is_file(*file), "the file of the avatar");
  for (const auto& place : state.bones) {
    require(!place || is_place(*place), "a bone's place");
  }
}

}  // namespace

bool is_participant_name(std::string_view text) {
  if (text.size() > 4 * kLongestName || !is_utf8(text)) {
    return false;
  }
  std::size_t count = 0;
  bool control = false;
  for_code_points(text, [&](char32_t point) {
    ++count;
    control = control || point < 0x20 || (point >= 0x7F && point < 0xA0);
  });
  return count >= 1 && count <= kLongestName && !control;
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
    require(is_promise(*presence.every), "so often nobody says something");
    message["every"] = *presence.every;
  }
  return message.dump();
}

Outcome<ParticipantState, MessageFault> read_state(std::string_view bytes) {
  try {
    const Json message = parse(bytes, kLongestState);
    ParticipantState state;
    state.session = session_of(message);
    state.kind = kind_of(message);
    state.name = text_of(member(message, "name"));
    if (!is_participant_name(state.name)) {
      refuse("name is not 1 to 40 characters without control characters");
    }
    if (const auto seat = whole(member(message, "seat"), 0, kMostSeats - 1)) {
      state.seat = static_cast<int>(*seat);
    }
    state.avatar = avatar_of(message);
    const Json& stature = member(message, "stature");
    if (stature.is_number() && is_stature(stature.get<double>())) {
      state.stature = stature.get<double>();
    }
    read_bones(message, state);
    return state;
  } catch (const Refused& refused) {
    return MessageFault{refused.words};
  }
}

Outcome<ParticipantPresence, MessageFault> read_presence(std::string_view bytes) {
  try {
    const Json message = parse(bytes, kLongestPresence);
    const Json& here = member(message, "here");
    if (!here.is_boolean()) {
      refuse("here is neither true nor false");
    }
    ParticipantPresence presence{here.get<bool>(), session_of(message), std::nullopt};
    const Json& every = member(message, "every");
    if (every.is_number() && is_promise(every.get<double>())) {
      presence.every = every.get<double>();
    }
    return presence;
  } catch (const Refused& refused) {
    return MessageFault{refused.words};
  }
}

}  // namespace telemime::meeting
