// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "meeting/protocol/outcome.h"
#include "telemime/outputs/humanoid.h"

namespace telemime::meeting {

/// Sizes of a pose frame in bytes: the part before the confidences, a rotation, and the longest frame.
inline constexpr std::size_t kPoseFrameHead = 26;
inline constexpr std::size_t kMostFrameBones = 18;
inline constexpr std::size_t kPackedRotationBytes = 6;
inline constexpr std::size_t kLongestPoseFrame =
    kPoseFrameHead + kMostFrameBones / 2 + kMostFrameBones * kPackedRotationBytes;

/// The pose of one participant at one moment: version 1 of the message `pose` (meeting/docs/protocol.md).
struct PoseFrame {
  PoseFrame() { rotation.fill(Eigen::Quaterniond::Identity()); }

  bool tracked = false;        ///< false: the person is lost, and `mask` is 0
  bool still = false;          ///< a sign of life of a person who does not move
  std::uint16_t session = 1;   ///< number of the publisher's run; not 0
  std::uint32_t sequence = 0;  ///< counts the frames of a session from 0
  std::uint64_t captured = 0;  ///< capture time, us of the publisher's monotonic clock
  std::uint32_t mask = 0;      ///< bit i: bone i of kHumanBoneNames is present; at most kMostFrameBones
  std::array<std::int16_t, 3> hips{};                      ///< mm, as HumanoidMotion::hips
  std::array<std::uint8_t, kHumanBoneCount> confidence{};  ///< 0 unknown, 1 (hardly) to 15 (sure)
  std::array<Eigen::Quaterniond, kHumanBoneCount>
      rotation;  ///< parent from bone, as HumanoidMotion::rotation

  bool has(std::size_t bone) const { return (mask >> bone & 1U) != 0; }
};

/// Why bytes are not a pose frame: the first of these reasons that applies. Bytes of version 1 that are
/// shorter than kPoseFrameHead have the wrong size, whatever else they contain.
enum class PoseFault {
  unknown_version,  ///< the first byte is not 1
  no_session,       ///< the session is 0
  unknown_bones,    ///< the mask has a bit without a bone
  too_many_bones,   ///< more than kMostFrameBones
  lost_with_bones,  ///< not tracked, but there are bones
  wrong_size,       ///< not the size that follows from the mask
  unused_half,      ///< the last half byte of an odd number of confidences is not 0
  unused_bit,       ///< the highest bit of a rotation is not 0
  not_a_rotation,   ///< rejected by unpack_rotation()
};
inline constexpr std::array<std::string_view, 9> kPoseFaultNames = {
    "unknown_version", "no_session",  "unknown_bones", "too_many_bones", "lost_with_bones",
    "wrong_size",      "unused_half", "unused_bit",    "not_a_rotation"};
inline std::string_view name_of(PoseFault fault) {
  return kPoseFaultNames[static_cast<std::size_t>(fault)];
}

/// Encodes a frame. Throws Error(usage) when the frame violates a rule above: session 0, bones while lost, a
/// mask or confidence out of range, a rotation that is not finite or has length 0.
std::vector<std::uint8_t> encode(const PoseFrame& frame);

/// Decodes a frame. Never throws.
Outcome<PoseFrame, PoseFault> decode_pose_frame(std::span<const std::uint8_t> bytes);

}  // namespace telemime::meeting
