// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "telemime/body/skeleton.h"

namespace telemime {

/// Joints of a hand: the wrist, then four points each of the thumb and of the fingers, from the base to the
/// tip.
inline constexpr std::size_t kHandJointCount = 21;
inline constexpr std::array<std::string_view, kHandJointCount> kHandJointNames = {
    "wrist",     "thumb_cmc", "thumb_mcp",  "thumb_ip",   "thumb_tip",  "index_mcp",  "index_pip",
    "index_dip", "index_tip", "middle_mcp", "middle_pip", "middle_dip", "middle_tip", "ring_mcp",
    "ring_pip",  "ring_dip",  "ring_tip",   "little_mcp", "little_pip", "little_dip", "little_tip"};
using HandPoints = std::array<Eigen::Vector3d, kHandJointCount>;
inline HandPoints points_at_origin() {
  HandPoints points;
  points.fill(Eigen::Vector3d::Zero());
  return points;
}

/// Thumb, index, middle, ring and little finger, in the order of the joints.
inline constexpr std::size_t kFingerCount = 5;
/// The joint of a hand at a finger's base (0) to its tip (3).
constexpr std::size_t hand_joint(std::size_t finger, std::size_t point) {
  return 1 + 4 * finger + point;
}

/// Angles of the fingers. 0 everywhere is the flat hand: the fingers straight and parallel, the thumb at 45
/// degrees to them in the plane of the palm. Flexion bends toward the palm; spread and abduction turn toward
/// the thumb's side, and the thumb away from the palm. The end joint of a finger bends by 2/3 of the middle
/// one.
inline constexpr std::size_t kHandAngleCount = 16;
inline constexpr std::array<std::string_view, kHandAngleCount> kHandAngleNames = {
    "thumb_flexion", "thumb_abduction", "thumb_mcp",     "thumb_ip",   "index_mcp", "index_spread",
    "index_pip",     "middle_mcp",      "middle_spread", "middle_pip", "ring_mcp",  "ring_spread",
    "ring_pip",      "little_mcp",      "little_spread", "little_pip"};
using HandAngles = std::array<double, kHandAngleCount>;  // rad
inline constexpr double kDipOfPip = 2.0 / 3.0;
/// The first angle of each finger, then the number of all; the thumb has one more than the others.
inline constexpr std::array<std::size_t, kFingerCount + 1> kFirstFingerAngle = {0, 4, 7, 10, 13, 16};

struct AngleRange {
  double min = 0.0, max = 0.0;  ///< rad
};
/// Anatomical limits of the angles (docs/hands.md).
const std::array<AngleRange, kHandAngleCount>& hand_limits();

/// Slightly bent fingers of a hand that does nothing.
HandAngles resting_hand();

/// The three angles of a wrist, as in the pose: R = Ry(twisting) Rx(pivot) Rz(flexion), forearm from hand;
/// rad.
struct WristAngles {
  double twisting = 0.0, pivot = 0.0, flexion = 0.0;
};
Eigen::Matrix3d wrist_rotation(const WristAngles& angles);
/// The angles of this rotation within the limits of a wrist, which are wider than those of a pose.
WristAngles wrist_angles(const Eigen::Matrix3d& forearm_from_hand);

/// Sizes of a person's hand, constant for one person. Lengths but `palm` are shares of the palm, places are
/// those of a left hand in its frame: the wrist at the origin, the fingers of the flat hand along -y, the
/// palm facing -x, the thumb on the side of +z.
struct HandSizes {
  double palm = 0.086;                                   ///< wrist to middle knuckle, m
  std::array<Eigen::Vector3d, kFingerCount> base;        ///< of each finger
  std::array<std::array<double, 3>, kFingerCount> bone;  ///< lengths from the base to the tip
};

/// Average proportions (Buchholz, Armstrong & Goldstein, Ergonomics 35, 1992) for this stature (m). The
/// palm's length is that of de Leva (1996), the mean of women and men.
HandSizes average_hand(double stature);

/// Rotations of the three bones of each finger, parent from bone, in the axes of the flat hand: identity for
/// 0.
std::array<std::array<Eigen::Matrix3d, 3>, kFingerCount> finger_rotations(const HandAngles& angles,
                                                                          Side side);

/// Forward kinematics: m, in the frame of `frame_from_hand`. A right hand is the mirror image (x = 0) of a
/// left.
HandPoints hand_points(const HandSizes& sizes, const HandAngles& angles, Side side,
                       const Eigen::Isometry3d& frame_from_hand);

/// How the palm behind 21 points in any unit is turned, frame from hand: by the wrist and the four knuckles
/// alone, in closed form (Kabsch 1976). Empty if a point is not finite or the palm is no larger than a point.
std::optional<Eigen::Matrix3d> palm_rotation(const HandSizes& sizes, const HandPoints& points, Side side);

}  // namespace telemime
