// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/pose_frame.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "meeting/protocol/little_endian.h"
#include "meeting/protocol/packed_rotation.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::uint8_t kTracked = 1;
constexpr std::uint8_t kStill = 2;
constexpr std::uint32_t kKnownBones = (1U << kHumanBoneCount) - 1U;
constexpr std::uint8_t kMostConfidence = 15;

std::size_t size_of(std::uint32_t mask) {
  const auto bones = static_cast<std::size_t>(std::popcount(mask));
  return kPoseFrameHead + (bones + 1) / 2 + bones * kPackedRotationBytes;
}

std::optional<PoseFault> fault_of_head(const PoseFrame& frame) {
  if (frame.session == 0) {
    return PoseFault::no_session;
  }
  if ((frame.mask & ~kKnownBones) != 0) {
    return PoseFault::unknown_bones;
  }
  if (static_cast<std::size_t>(std::popcount(frame.mask)) > kMostFrameBones) {
    return PoseFault::too_many_bones;
  }
  if (!frame.tracked && frame.mask != 0) {
    return PoseFault::lost_with_bones;
  }
  return std::nullopt;
}

void require_writable(const PoseFrame& frame) {
  if (const auto fault = fault_of_head(frame)) {
    throw Error(ErrorKind::usage, "this pose frame cannot be written: " + std::string(name_of(*fault)));
  }
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    const Eigen::Vector4d& q = frame.rotation[bone].coeffs();
    if (frame.has(bone) &&
        (frame.confidence[bone] > kMostConfidence || !q.allFinite() || !(q.norm() > 0.0))) {
      throw Error(ErrorKind::usage, "this pose frame cannot be written: the confidence or rotation of " +
                                        std::string(kHumanBoneNames[bone]) + " is invalid");
    }
  }
}

PoseFrame read_head(ByteReader& reader) {
  PoseFrame frame;
  reader.take(1);  // the version
  const std::uint64_t flags = reader.take(1);
  frame.tracked = (flags & kTracked) != 0;
  frame.still = (flags & kStill) != 0;
  frame.session = static_cast<std::uint16_t>(reader.take(2));
  frame.sequence = static_cast<std::uint32_t>(reader.take(4));
  frame.captured = reader.take(8);
  frame.mask = static_cast<std::uint32_t>(reader.take(4));
  for (std::int16_t& coordinate : frame.hips) {
    coordinate = static_cast<std::int16_t>(reader.take(2));
  }
  return frame;
}

std::optional<PoseFault> read_confidences(ByteReader& reader, PoseFrame& frame) {
  std::uint64_t pair = 0;
  bool second = false;
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    if (frame.has(bone)) {
      pair = second ? pair >> 4U : reader.take(1);
      frame.confidence[bone] = static_cast<std::uint8_t>(pair & 15U);
      second = !second;
    }
  }
  return second && pair > 15U ? std::optional(PoseFault::unused_half) : std::nullopt;
}

std::optional<PoseFault> read_rotations(ByteReader& reader, PoseFrame& frame) {
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    if (!frame.has(bone)) {
      continue;
    }
    const std::uint64_t bits = reader.take(kPackedRotationBytes);
    if ((bits >> kPackedRotationBits) != 0) {
      return PoseFault::unused_bit;
    }
    const auto rotation = unpack_rotation(bits);
    if (!rotation) {
      return PoseFault::not_a_rotation;
    }
    frame.rotation[bone] = *rotation;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::uint8_t> encode(const PoseFrame& frame) {
  require_writable(frame);
  // The head: flags, counters, time, bones, position of the hips.
  ByteWriter writer(size_of(frame.mask));
  writer.put(kVersion, 1);
  writer.put((frame.tracked ? kTracked : 0U) | (frame.still ? kStill : 0U), 1);
  writer.put(frame.session, 2);
  writer.put(frame.sequence, 4);
  writer.put(frame.captured, 8);
  writer.put(frame.mask, 4);
  for (const std::int16_t coordinate : frame.hips) {
    writer.put(static_cast<std::uint16_t>(coordinate), 2);
  }
  // Two confidences per byte, the first in the low half.
  std::vector<std::uint8_t> confidences;
  bool second = false;
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    if (!frame.has(bone)) {
      continue;
    }
    if (second) {
      confidences.back() |= static_cast<std::uint8_t>(frame.confidence[bone] << 4U);
    } else {
      confidences.push_back(frame.confidence[bone]);
    }
    second = !second;
  }
  for (const std::uint8_t pair : confidences) {
    writer.put(pair, 1);
  }
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    if (frame.has(bone)) {
      writer.put(pack_rotation(frame.rotation[bone]), kPackedRotationBytes);
    }
  }
  return writer.take();
}

Outcome<PoseFrame, PoseFault> decode_pose_frame(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) {
    return PoseFault::wrong_size;
  }
  if (bytes[0] != kVersion) {  // another version may have another size
    return PoseFault::unknown_version;
  }
  if (bytes.size() < kPoseFrameHead) {
    return PoseFault::wrong_size;
  }
  ByteReader reader(bytes);
  PoseFrame frame = read_head(reader);
  if (const auto fault = fault_of_head(frame)) {
    return *fault;
  }
  if (bytes.size() != size_of(frame.mask)) {
    return PoseFault::wrong_size;
  }
  if (const auto fault = read_confidences(reader, frame)) {
    return *fault;
  }
  if (const auto fault = read_rotations(reader, frame)) {
    return *fault;
  }
  return frame;
}

}  // namespace telemime::meeting
