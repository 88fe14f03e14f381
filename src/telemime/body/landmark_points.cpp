// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/landmark_points.h"

namespace telemime {

// `telemime-lab learn landmarks` finds shoulders, elbows, wrists and the sides of eyes and ears to within
// 0.01. The rest of the face and the knuckles are an earlier estimate, on synthetic people of whom it was not
// known how head and hands were turned (docs/networks.md#face-points). Deviations are 1.5 to 3 times those on
// synthetic people: real images are harder.
// Hips by anthropometry (de Leva, J. Biomechanics 29, 1996: mid-shoulder to mid-hip); those of drawn people
// are elsewhere, and a person would lean forward by 20 degrees.
const std::array<LandmarkPoint, kLandmarkCount> kLandmarkPoints = {{
    {"nose", Joint::neck, Segment::head, {0.0000, 0.0818, 0.0465}, 0.010},
    {"l_eye", Joint::neck, Segment::head, {0.0176, 0.0976, 0.0471}, 0.010},
    {"r_eye", Joint::neck, Segment::head, {-0.0176, 0.0976, 0.0471}, 0.010},
    {"l_ear", Joint::neck, Segment::head, {0.0353, 0.0853, 0.0329}, 0.010},
    {"r_ear", Joint::neck, Segment::head, {-0.0353, 0.0853, 0.0329}, 0.010},
    {"l_shoulder", Joint::l_shoulder, Segment::chest, {0.0000, 0.0094, 0.0000}, 0.015},
    {"r_shoulder", Joint::r_shoulder, Segment::chest, {0.0000, 0.0094, 0.0000}, 0.015},
    {"l_elbow", Joint::l_elbow, Segment::l_upper_arm, {0.0000, 0.0018, 0.0071}, 0.018},
    {"r_elbow", Joint::r_elbow, Segment::r_upper_arm, {0.0000, 0.0018, 0.0071}, 0.018},
    {"l_wrist", Joint::l_wrist, Segment::l_forearm, {-0.0024, -0.0088, 0.0024}, 0.018},
    {"r_wrist", Joint::r_wrist, Segment::r_forearm, {0.0024, -0.0088, 0.0024}, 0.018},
    {"l_pinky", Joint::l_wrist, Segment::l_hand, {0.0000, -0.0500, -0.0176}, 0.035},
    {"r_pinky", Joint::r_wrist, Segment::r_hand, {0.0000, -0.0500, -0.0176}, 0.035},
    {"l_index", Joint::l_wrist, Segment::l_hand, {0.0000, -0.0559, 0.0176}, 0.035},
    {"r_index", Joint::r_wrist, Segment::r_hand, {0.0000, -0.0559, 0.0176}, 0.035},
    {"l_hip", Joint::root, Segment::chest, {0.0635, -0.0100, 0.0060}, 0.040, OffsetSource::anthropometry},
    {"r_hip", Joint::root, Segment::chest, {-0.0635, -0.0100, 0.0060}, 0.040, OffsetSource::anthropometry},
}};

// Chosen, not learned: measured gains of arms are 0.1 to 0.7, with other offsets for each kind of people
// (docs/networks.md). These are a compromise with 1, with which slopes would be believed as reported.
const std::array<SlopeResponse, kLandmarkBoneCount> kLandmarkBoneResponse = {
    {{-0.05, 0.6}, {-0.05, 0.6}, {-0.15, 0.65}, {-0.15, 0.65}, {}, {}, {}}};
const std::array<double, kLandmarkBoneCount> kLandmarkBoneSigma = {0.2, 0.2, 0.18, 0.18, 0.1, 0.2, 0.3};

LandmarkPositions landmark_positions(const Body& body, const Kinematics& k) {
  LandmarkPositions points;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const LandmarkPoint& p = kLandmarkPoints[i];
    const SegmentScale& s = body.shape[p.axes];
    const Eigen::Vector3d offset(p.offset[0] * s.width, p.offset[1] * s.length, p.offset[2] * s.height);
    points[i] = k.joints[p.origin] + k[p.axes].linear() * (body.shape.stature * offset);
  }
  return points;
}

LandmarkPositions landmark_velocities(const LandmarkPositions& points, const Kinematics& k,
                                      const KinematicRate& rate) {
  LandmarkPositions velocities;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const LandmarkPoint& p = kLandmarkPoints[i];
    const Eigen::Vector3d& turn = rate.angular[static_cast<std::size_t>(p.axes)];
    velocities[i] = rate.joints[p.origin] + turn.cross(points[i] - k.joints[p.origin]);
  }
  return velocities;
}

std::array<Eigen::Vector3d, kLandmarkBoneCount> landmark_bones(const LandmarkPositions& points) {
  const auto at = [&](Landmark l) -> const Eigen::Vector3d& { return points[static_cast<std::size_t>(l)]; };
  const auto middle = [&](Landmark a, Landmark b) -> Eigen::Vector3d { return 0.5 * (at(a) + at(b)); };
  return {at(Landmark::l_elbow) - at(Landmark::l_shoulder),
          at(Landmark::r_elbow) - at(Landmark::r_shoulder),
          at(Landmark::l_wrist) - at(Landmark::l_elbow),
          at(Landmark::r_wrist) - at(Landmark::r_elbow),
          at(Landmark::l_shoulder) - at(Landmark::r_shoulder),
          middle(Landmark::l_shoulder, Landmark::r_shoulder) - middle(Landmark::l_hip, Landmark::r_hip),
          at(Landmark::nose) - middle(Landmark::l_ear, Landmark::r_ear)};
}

}  // namespace telemime
