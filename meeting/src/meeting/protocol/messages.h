// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "meeting/protocol/outcome.h"
#include "telemime/outputs/humanoid.h"

namespace telemime::meeting {

/// Bytes of the messages at most (docs/room-protocol.md).
inline constexpr std::size_t kLongestState = 4096;
inline constexpr std::size_t kLongestPresence = 256;
/// Of a participant's name: characters (Unicode code points).
inline constexpr std::size_t kLongestName = 40;
/// Seats are counted from 0.
inline constexpr int kMostSeats = 100;
/// Bytes of an avatar's file.
inline constexpr std::int64_t kLargestAvatar = std::int64_t{64} * 1024 * 1024;

enum class ParticipantKind { tracker, browser };

/// One of the project's own avatars.
struct AvatarByLook {
  std::string look;  ///< as is_topic_segment() asks
};

/// An avatar's file elsewhere.
struct AvatarFile {
  std::string url;         ///< https, without a user
  std::string sha256;      ///< of the file, 64 small hexadecimal digits
  std::int64_t bytes = 0;  ///< 1 to kLargestAvatar
};

/// Who a participant is and what they look like: the message `state`.
struct ParticipantState {
  std::uint16_t session = 1;  ///< not 0
  ParticipantKind kind = ParticipantKind::tracker;
  std::string name;         ///< 1 to kLongestName characters, no control characters
  std::optional<int> seat;  ///< that is asked for, 0 to kMostSeats - 1; nothing: any
  std::variant<std::monostate, AvatarByLook, AvatarFile> avatar;
  std::optional<double> stature;  ///< m, 0.3 to 3
  /// Joints of the skeleton in its T-pose, m (HumanoidSkeleton::position), within 10 m; those that are told.
  std::array<std::optional<Eigen::Vector3d>, kHumanBoneCount> bones;
};

/// Whether a participant is in the room: the message `presence`.
struct ParticipantPresence {
  bool here = false;
  std::uint16_t session = 1;  ///< not 0
  /// Something is said at least so often, s, kShortestPromise to kLongestPromise; nothing: no promise.
  std::optional<double> every = std::nullopt;
};

inline constexpr double kShortestPromise = 0.5;  // s
inline constexpr double kLongestPromise = 60.0;  // s

/// Why bytes are no such message, in words.
struct MessageFault {
  std::string words;
};

/// Whether the text can be a participant's name.
bool is_participant_name(std::string_view text);
/// Whether it can be told as a stature, m.
bool is_stature(double metres);

/// JSON without line breaks. Throw Error(usage) when the rules above are broken, or the message is too long.
std::string write_state(const ParticipantState& state);
std::string write_presence(const ParticipantPresence& presence);

/// The message of these bytes. Members that are not known are ignored; a seat or stature that is none counts
/// as not told; anything else that breaks a rule makes the whole message one that cannot be read. Never
/// throw.
Outcome<ParticipantState, MessageFault> read_state(std::string_view bytes);
Outcome<ParticipantPresence, MessageFault> read_presence(std::string_view bytes);

}  // namespace telemime::meeting
