// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "meeting/protocol/outcome.h"
#include "telemime/outputs/humanoid.h"

namespace telemime::meeting {

/// Maximum sizes of the messages, bytes (meeting/docs/protocol.md).
inline constexpr std::size_t kLongestState = 4096;
inline constexpr std::size_t kLongestPresence = 256;
/// Maximum length of a participant's name, Unicode code points.
inline constexpr std::size_t kLongestName = 40;
/// Seats are counted from 0.
inline constexpr int kMostSeats = 100;
/// Maximum size of an avatar file, bytes.
inline constexpr std::int64_t kLargestAvatar = std::int64_t{64} * 1024 * 1024;

enum class ParticipantKind { tracker, browser };

/// One of the avatars that the meeting's server has.
struct AvatarByLook {
  std::string look;  ///< is_topic_segment()
};

/// An avatar file on another server.
struct AvatarFile {
  std::string url;         ///< https, without user and password
  std::string sha256;      ///< of the file, 64 lower-case hexadecimal digits
  std::int64_t bytes = 0;  ///< 1 to kLargestAvatar
};

/// Who a participant is and how they look: the message `state`.
struct ParticipantState {
  std::uint16_t session = 1;  ///< not 0
  ParticipantKind kind = ParticipantKind::tracker;
  std::string name;         ///< is_participant_name()
  std::optional<int> seat;  ///< the requested seat, 0 to kMostSeats - 1; nothing: any
  std::variant<std::monostate, AvatarByLook, AvatarFile> avatar;
  std::optional<double> stature;  ///< m, is_stature()
  /// Joints of the skeleton in its T-pose, m (HumanoidSkeleton::position), each coordinate within 10 m.
  std::array<std::optional<Eigen::Vector3d>, kHumanBoneCount> bones;
};

/// Whether a participant is in the meeting: the message `presence`.
struct ParticipantPresence {
  bool here = false;
  std::uint16_t session = 1;  ///< not 0
  /// The participant promises to send something at least this often, s, kShortestPromise to kLongestPromise.
  std::optional<double> every = std::nullopt;
};

inline constexpr double kShortestPromise = 0.5;  // s
inline constexpr double kLongestPromise = 60.0;  // s

/// Why bytes are not a valid message.
struct MessageFault {
  std::string text;
};

/// Whether the text can be a participant's name: 1 to kLongestName characters, no control characters.
bool is_participant_name(std::string_view text);
/// Whether a stature is in [0.3, 3] m.
bool is_stature(double metres);

/// Writes a message as JSON without line breaks. Throws Error(usage) when a value is out of range or the
/// message is too long.
std::string write_state(const ParticipantState& state);
std::string write_presence(const ParticipantPresence& presence);

/// Reads a message. Unknown members are ignored; an invalid seat, stature or promise counts as missing; any
/// other violation makes the message invalid. Never throws.
Outcome<ParticipantState, MessageFault> read_state(std::string_view bytes);
Outcome<ParticipantPresence, MessageFault> read_presence(std::string_view bytes);

/// The participants of a meeting, from their presence messages.
class Attendance {
 public:
  /// Applies a presence message; an empty one (a cleared topic) removes the participant. The end of an older
  /// session does not remove a newer one. An invalid message changes nothing.
  void update(const std::string& participant, std::string_view message);
  std::size_t count() const { return sessions_.size(); }
  bool has(const std::string& participant) const { return sessions_.contains(participant); }

 private:
  std::map<std::string, std::uint16_t> sessions_;
};

}  // namespace telemime::meeting
