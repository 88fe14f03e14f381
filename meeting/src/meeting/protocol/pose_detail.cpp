// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/pose_detail.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "meeting/protocol/little_endian.h"
#include "telemime/body/rotations.h"
#include "telemime/core/errors.h"
#include "telemime/outputs/numbers.h"

namespace telemime::meeting {
namespace {

constexpr std::uint8_t kVersion = 2;
constexpr std::uint8_t kWithFingers = 1;
constexpr std::uint8_t kWithFace = 2;
constexpr std::uint8_t kKnown = kWithFingers | kWithFace;
constexpr double kGazeSteps = 2.0;  // per degree
constexpr double kMostGaze = 127.0;
constexpr double kFull = 255.0;

/// The number of axes about which a finger bone turns, from z to x.
constexpr int axes_of(std::size_t bone) {
  const std::size_t in_hand = bone % 15;
  return in_hand < 3 ? 3 : in_hand % 3 == 0 ? 2 : 1;
}

std::uint8_t weight(double value) {
  return static_cast<std::uint8_t>(std::lround(kFull * std::clamp(value, 0.0, 1.0)));
}

std::int8_t signed_step(double value, double most) {
  return static_cast<std::int8_t>(std::lround(std::clamp(value, -most, most)));
}

bool is_angle(std::int8_t degrees) {
  return std::abs(degrees) <= kMostFingerDegrees;
}

std::size_t size_of(unsigned sections) {
  return kPoseDetailHead + ((sections & kWithFingers) != 0 ? kFingerAngleCount : 0) +
         ((sections & kWithFace) != 0 ? kFaceBytes : 0);
}

}  // namespace

PoseDetail::Fingers quantised(const FingerRotations& fingers) {
  PoseDetail::Fingers out{};
  std::size_t next = 0;
  for (std::size_t bone = 0; bone < kFingerBoneCount; ++bone) {
    const Eigen::Matrix3d r = fingers[bone].toRotationMatrix();
    const std::array<double, 3> zyx = {std::atan2(r(1, 0), r(0, 0)),
                                       std::asin(std::clamp(-r(2, 0), -1.0, 1.0)),
                                       std::atan2(r(2, 1), r(2, 2))};
    for (int axis = 0; axis < axes_of(bone); ++axis) {
      out[next++] = signed_step(zyx[static_cast<std::size_t>(axis)] * kDegreesPerRadian, kMostFingerDegrees);
    }
  }
  return out;
}

FingerRotations rotations_of(const PoseDetail::Fingers& fingers) {
  FingerRotations out;
  std::size_t next = 0;
  for (std::size_t bone = 0; bone < kFingerBoneCount; ++bone) {
    std::array<double, 3> zyx{};
    for (int axis = 0; axis < axes_of(bone); ++axis) {
      zyx[static_cast<std::size_t>(axis)] = fingers[next++] / kDegreesPerRadian;
    }
    out[bone] =
        Eigen::Quaterniond(Eigen::Matrix3d(rotation_z(zyx[0]) * rotation_y(zyx[1]) * rotation_x(zyx[2])));
  }
  return out;
}

FaceDetail quantised(const FaceMotion& face) {
  FaceDetail out;
  out.confidence = weight(face.confidence);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double degrees = face.gaze[static_cast<Eigen::Index>(axis)] * kDegreesPerRadian;
    out.gaze[axis] = signed_step(kGazeSteps * degrees, kMostGaze);
  }
  std::transform(face.expressions.begin(), face.expressions.end(), out.arkit.begin(), weight);
  const auto vrm = vrm_expressions(face);
  std::transform(vrm.begin(), vrm.end(), out.vrm.begin(), weight);
  return out;
}

bool is_pose_detail(std::string_view bytes) {
  return !bytes.empty() && static_cast<std::uint8_t>(bytes[0]) == kVersion;
}

std::vector<std::uint8_t> encode(const PoseDetail& detail) {
  if (detail.session == 0 ||
      (detail.fingers && !std::all_of(detail.fingers->begin(), detail.fingers->end(), is_angle))) {
    throw Error(ErrorKind::usage,
                "this detail of a pose cannot be written: its session or a finger is invalid");
  }
  const unsigned sections = (detail.fingers ? kWithFingers : 0U) | (detail.face ? kWithFace : 0U);
  ByteWriter writer(size_of(sections));
  const auto put_all = [&writer](const auto& values) {
    for (const auto value : values) {
      writer.put(static_cast<std::uint8_t>(value), 1);
    }
  };
  writer.put(kVersion, 1);
  writer.put(sections, 1);
  writer.put(detail.session, 2);
  writer.put(detail.sequence, 4);
  if (detail.fingers) {
    put_all(*detail.fingers);
  }
  if (detail.face) {
    writer.put(detail.face->confidence, 1);
    put_all(detail.face->gaze);
    put_all(detail.face->arkit);
    put_all(detail.face->vrm);
  }
  return writer.take();
}

Outcome<PoseDetail, DetailFault> decode_pose_detail(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) {
    return DetailFault::wrong_size;
  }
  if (bytes[0] != kVersion) {
    return DetailFault::unknown_version;
  }
  if (bytes.size() < kPoseDetailHead || bytes.size() > kLongestPoseDetail) {
    return DetailFault::wrong_size;
  }
  ByteReader reader(bytes);
  reader.take(1);  // the version
  const auto sections = static_cast<unsigned>(reader.take(1));
  const std::size_t size = size_of(sections);
  if ((sections & ~kKnown) != 0 ? bytes.size() < size : bytes.size() != size) {
    return DetailFault::wrong_size;
  }
  PoseDetail detail;
  detail.session = static_cast<std::uint16_t>(reader.take(2));
  detail.sequence = static_cast<std::uint32_t>(reader.take(4));
  if (detail.session == 0) {
    return DetailFault::no_session;
  }
  const auto take_all = [&reader](auto& values) {
    for (auto& value : values) {
      value = static_cast<std::remove_reference_t<decltype(value)>>(reader.take(1));
    }
  };
  if ((sections & kWithFingers) != 0) {
    take_all(detail.fingers.emplace());
    if (!std::all_of(detail.fingers->begin(), detail.fingers->end(), is_angle)) {
      return DetailFault::no_angle;
    }
  }
  if ((sections & kWithFace) != 0) {
    FaceDetail& face = detail.face.emplace();
    face.confidence = static_cast<std::uint8_t>(reader.take(1));
    take_all(face.gaze);
    take_all(face.arkit);
    take_all(face.vrm);
  }
  return detail;
}

}  // namespace telemime::meeting
