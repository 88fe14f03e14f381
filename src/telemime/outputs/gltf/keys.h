// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "telemime/body/motion_frame.h"
#include "telemime/outputs/gltf/document.h"
#include "telemime/outputs/gltf/humanoid.h"
#include "telemime/outputs/humanoid.h"

namespace telemime {

/// The bones of the upper body, each with a track: all before the legs.
inline constexpr std::size_t kMovingBoneCount = static_cast<std::size_t>(HumanBone::l_upper_leg);

/// A motion as the keys of a glTF animation.
class MotionKeys {
 public:
  /// With fingers, they get tracks; with the first of the nodes of the face (add_face_nodes), expressions and
  /// gaze, too.
  MotionKeys(const Body& body, bool fingers, std::optional<std::size_t> face_node);

  /// Adds a frame with finite numbers. A lost frame makes no key; the pose before it is held until the frame
  /// before the next key, so that nothing glides through the gap. A frame that is not later than the previous
  /// one is skipped.
  void add(const MotionFrame& frame);

  /// Keys of tracked frames and of held poses so far.
  std::size_t count() const { return columns_.times.size(); }

  /// Adds one animation with linear tracks: the translation of the hips and the rotation of every moving
  /// bone, for nodes that are numbered like the bones. There is always at least one key: the rest pose, if
  /// nothing was tracked.
  void add_animation(GltfDocument& document) const;

  /// The position of the root (m, camera frame) at which the hips are as in the T-pose: that of the first
  /// tracked frame.
  const std::optional<Eigen::Vector3d>& origin() const { return origin_; }

  /// The fingers of the last frame with hands: their lengths are learned while the person is tracked.
  const std::optional<FingerSkeleton>& fingers() const { return skeleton_; }

 private:
  struct Columns {
    std::vector<float> times;  ///< s from the first frame
    std::vector<float> hips;
    std::array<std::vector<float>, kMovingBoneCount> rotations;  ///< x, y, z, w

    std::array<std::vector<float>, kFingerBoneCount> fingers;  ///< the same; empty without

    std::array<std::vector<float>, kAnimatedExpressionCount> expressions;  ///< x is the weight
    std::vector<float> gaze;                                               ///< x, y, z, w

    void add(float time, const HumanoidMotion& motion);
    void add_fingers(const std::optional<FingerRotations>& turned);
    void add_face(const FaceMotion& face);
    void hold(float time);
  };

  Body body_;
  bool fingers_;
  std::optional<FingerSkeleton> skeleton_;
  std::optional<std::size_t> face_node_;
  Columns columns_;
  std::optional<double> start_;  ///< time of the first frame
  float last_time_ = -1.0F;
  bool lost_ = false;  ///< since the last key
  std::optional<Eigen::Vector3d> origin_;
};

}  // namespace telemime
