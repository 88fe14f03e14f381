// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "meeting/protocol/outcome.h"
#include "telemime/outputs/humanoid.h"
#include "telemime/outputs/vrm_expressions.h"

namespace telemime::meeting {

/// Sizes of a detail in bytes: the part before the sections, the fingers of both hands, the face, the
/// longest.
inline constexpr std::size_t kPoseDetailHead = 8;
inline constexpr std::size_t kFingerAngleCount = 50;
inline constexpr std::size_t kFaceBytes = 3 + kExpressionCount + kVrmExpressionCount;
inline constexpr std::size_t kLongestPoseDetail = 256;

/// Of a face: confidence and weights in 1/255, gaze in half degrees to the person's left and up.
struct FaceDetail {
  std::uint8_t confidence = 0;
  std::array<std::int8_t, 2> gaze{};
  std::array<std::uint8_t, kExpressionCount> arkit{};   ///< by kExpressionNames
  std::array<std::uint8_t, kVrmExpressionCount> vrm{};  ///< by kVrmExpressionNames
  bool operator==(const FaceDetail&) const = default;
};

/// Fingers and face of one pose frame, as they are sent: version 2 of the message `pose`
/// (meeting/docs/protocol.md), which clients of version 1 drop.
struct PoseDetail {
  using Fingers = std::array<std::int8_t, kFingerAngleCount>;

  std::uint16_t session = 1;  ///< of the pose frame, like the sequence
  std::uint32_t sequence = 0;
  std::optional<Fingers> fingers;  ///< degrees, see quantised(); at most kMostFingerDegrees
  std::optional<FaceDetail> face;
};

inline constexpr int kMostFingerDegrees = 120;

/// Whole degrees of each finger bone in the order of kFingerBoneNames, with R = Rz Ry Rx: about z, y and x
/// for a bone of the thumb, about z and y for the first bone of a finger, about z for the others.
PoseDetail::Fingers quantised(const FingerRotations& fingers);
FingerRotations rotations_of(const PoseDetail::Fingers& fingers);

FaceDetail quantised(const FaceMotion& face);

/// Why bytes are not a detail: the first of these reasons that applies.
enum class DetailFault {
  unknown_version,  ///< the first byte is not 2
  wrong_size,       ///< not the size that follows from the flags, or less where unknown sections may follow
  no_session,       ///< the session is 0
  no_angle,         ///< a finger is bent by more than kMostFingerDegrees
};
inline constexpr std::array<std::string_view, 4> kDetailFaultNames = {"unknown_version", "wrong_size",
                                                                      "no_session", "no_angle"};
inline std::string_view name_of(DetailFault fault) {
  return kDetailFaultNames[static_cast<std::size_t>(fault)];
}

/// Whether a message of the topic `pose` has the version of a detail.
bool is_pose_detail(std::string_view bytes);

/// Encodes a detail. Throws Error(usage) for session 0 and for an angle out of range.
std::vector<std::uint8_t> encode(const PoseDetail& detail);

/// Decodes a detail; sections that are unknown are left out. Never throws.
Outcome<PoseDetail, DetailFault> decode_pose_detail(std::span<const std::uint8_t> bytes);

}  // namespace telemime::meeting
