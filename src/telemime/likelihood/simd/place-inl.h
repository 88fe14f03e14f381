// SPDX-License-Identifier: Apache-2.0
// Transforms of the segments from pose numbers: a block of poses at once, one pose per lane.
#if defined(TELEMIME_SIMD_PLACE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TELEMIME_SIMD_PLACE_INL_H
#undef TELEMIME_SIMD_PLACE_INL_H
#else
#define TELEMIME_SIMD_PLACE_INL_H
#endif

#include <algorithm>
#include <cmath>

#include "telemime/likelihood/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace telemime::simd::HWY_NAMESPACE {

inline void store_transform(const FloatVector* transform, Segment segment, Workspace& ws) {
  for (std::size_t k = 0; k < 12; ++k) {
    hn::Store(transform[k], kFloat, ws.transform[12 * static_cast<std::size_t>(segment) + k]);
  }
}

// sine_cosine() is exact for a few thousand turns; poses rarely have more than one.
inline double within_a_turn(double angle) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return std::abs(angle) <= kTurn ? angle : std::remainder(angle, kTurn);
}

// Lanes after the last pose hold copies of it.
inline void load_poses(std::span<const Pose> poses, Workspace& ws) {
  for (std::size_t lane = 0; lane < poses.size(); ++lane) {
    const Pose& pose = poses[lane];
    for (std::size_t i = 0; i < 3; ++i) {
      ws.pose[i][lane] = static_cast<float>(pose.root[static_cast<Eigen::Index>(i)]);
    }
    for (std::size_t i = 0; i < kAngleCount; ++i) {
      ws.pose[3 + i][lane] = static_cast<float>(within_a_turn(pose.angles[i]));
    }
  }
  for (auto& number_of_lanes : ws.pose) {
    std::fill(number_of_lanes + poses.size(), number_of_lanes + kN, number_of_lanes[poses.size() - 1]);
  }
}

// At most kN poses.
inline void place_segments(const PackedSkeleton& skeleton, std::span<const Pose> poses, Workspace& ws) {
  load_poses(poses, ws);
  FloatVector pose[23];
  for (std::size_t i = 0; i < 23; ++i) {
    pose[i] = hn::Load(kFloat, ws.pose[i]);
  }
  FloatVector chest[12];
  FloatVector upper[12];
  FloatVector fore[12];
  FloatVector hand[12];
  place_chest(pose, chest);
  store_transform(chest, Segment::chest, ws);
  const auto& neck = skeleton.neck_from_root;
  place_head(pose, chest, number(neck[0]), number(neck[1]), number(neck[2]), upper);
  store_transform(upper, Segment::head, ws);
  constexpr auto kFirst = [](Angle a) { return 3 + static_cast<int>(a); };
  for (const Side side : {Side::left, Side::right}) {
    const auto i = static_cast<std::size_t>(side);
    const bool left = side == Side::left;
    const auto& joint = skeleton.shoulder_from_root[i];
    const FloatVector shoulder[3] = {number(joint[0]), number(joint[1]), number(joint[2])};
    place_arm(pose, kFirst(left ? Angle::l_shoulder_flexion : Angle::r_shoulder_flexion),
              kFirst(left ? Angle::l_elbow_flexion : Angle::r_elbow_flexion),
              kFirst(left ? Angle::l_wrist_flexion : Angle::r_wrist_flexion), chest, shoulder,
              number(skeleton.clavicle_lift), number(skeleton.clavicle_reach), number(skeleton.upper_arm[i]),
              number(skeleton.forearm[i]), upper, fore, hand);
    store_transform(upper, left ? Segment::l_upper_arm : Segment::r_upper_arm, ws);
    store_transform(fore, left ? Segment::l_forearm : Segment::r_forearm, ws);
    store_transform(hand, left ? Segment::l_hand : Segment::r_hand, ws);
  }
}

}  // namespace telemime::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // TELEMIME_SIMD_PLACE_INL_H
