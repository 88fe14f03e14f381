// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "telemime/body/body.h"
#include "telemime/body/kinematic_rates.h"

namespace telemime {

/// Points of the upper body that learned networks find in a picture. l_ and r_ are the person's own sides.
enum class Landmark : std::size_t {
  nose,
  l_eye,
  r_eye,
  l_ear,
  r_ear,
  l_shoulder,
  r_shoulder,
  l_elbow,
  r_elbow,
  l_wrist,
  r_wrist,
  l_pinky,
  r_pinky,
  l_index,
  r_index,
  l_hip,
  r_hip,
};
inline constexpr std::size_t kLandmarkCount = 17;

/// Where the offset of a landmark comes from.
enum class OffsetSource : std::uint8_t {
  learned,  ///< synthetic people: `telemime-lab learn landmarks`, or an earlier estimate (see the table)
  anthropometry,  ///< measured people: synthetic ones differ, or hide the landmark
};

/// One landmark on the model: a fixed point of a segment. Networks are annotated on the surface, so that
/// their joints differ from the joint centres by an offset, which is the same for everybody in proportion to
/// the stature.
struct LandmarkPoint {
  std::string_view name;
  Joint origin;
  Segment axes;
  /// From the origin, in the segment's axes at rest, as shares of the stature. A right landmark has the
  /// mirror image of the left one's.
  std::array<double, 3> offset;
  double sigma;  ///< standard deviation in the picture of a landmark that is clearly visible, m on the body
  OffsetSource source = OffsetSource::learned;
};

/// The landmarks in the order of the enumeration: the only table of these numbers (docs/networks.md).
extern const std::array<LandmarkPoint, kLandmarkCount> kLandmarkPoints;

using LandmarkPositions = std::array<Eigen::Vector3d, kLandmarkCount>;

/// All landmarks of a body in a pose, m, camera frame.
LandmarkPositions landmark_positions(const Body& body, const Kinematics& kinematics);

/// Velocities (m/s, camera frame) of the landmarks of a body that moves at `rate` (see kinematic_rates()).
/// `points` are landmark_positions() of `kinematics`.
LandmarkPositions landmark_velocities(const LandmarkPositions& points, const Kinematics& kinematics,
                                      const KinematicRate& rate);

/// Lines between landmarks (or the middles of two) whose direction in depth a network estimates.
enum class LandmarkBone : std::size_t {
  l_upper_arm,
  r_upper_arm,
  l_forearm,
  r_forearm,
  shoulders,  ///< right to left
  trunk,      ///< middle of the hips to the middle of the shoulders
  face,       ///< middle of the ears to the nose
};
inline constexpr std::size_t kLandmarkBoneCount = 7;

/// What a network reports on average of a slope in depth (a share of the bone's length): offset + gain *
/// slope. A gain (above 0) below 1: the reports are nearer to a usual slope, offset / (1 - gain), than the
/// bones are.
struct SlopeResponse {
  double offset = 0.0;
  double gain = 1.0;
};
extern const std::array<SlopeResponse, kLandmarkBoneCount> kLandmarkBoneResponse;

/// Standard deviation of what a network reports of a bone's slope, about this average.
extern const std::array<double, kLandmarkBoneCount> kLandmarkBoneSigma;

/// All bones between these landmarks, from start to end, in their frame and unit.
std::array<Eigen::Vector3d, kLandmarkBoneCount> landmark_bones(const LandmarkPositions& points);

}  // namespace telemime
