// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "telemime/search/shape_fit.h"

namespace telemime {

/// Settings of refine_shape; part of the table of CalibrationConfig.
struct ShapeRefineConfig {
  int keyframes = 8;
  int rounds = 2;
  int pose_iterations = 100;
  int shapes = 60;
  double natural_weight = 0.02;
  double prior_weight = 0.002;
};

/// A frame and the pose that was estimated in it.
struct Keyframe {
  PreparedFrame frame;
  Pose pose;
  double region = 0.0;  ///< F of the pose
};

struct ShapeRefinement {
  Shape shape;
  std::vector<Pose> poses;  ///< of the keyframes, with the new shape
  double cost_before = 0.0;
  double cost = 0.0;  ///< mean over the keyframes, prior included
  int evaluations = 0;
};

using BackendMaker = std::function<std::unique_ptr<Backend>()>;

/// Whether elbows, wrists and hands are inside the image.
bool shows_arms(const Body& body, const Keyframe& keyframe);

/// Indices, in rising order, of at most `count` candidates: the first good one, then repeatedly the one whose
/// arms are farthest from those already picked. A good candidate shows both arms and has an F of at most 1.1
/// times the median.
std::vector<std::size_t> pick_keyframes(const Body& body, std::span<const Keyframe> candidates,
                                        std::size_t count);

/// The pose for a body of other lengths: the trunk stays; elbows and wrists stay on their viewing rays, at
/// the depth that the new lengths require, on the same side (nearer or farther) of their parent joint.
Pose carry_pose(const Body& from, const Body& to, const Pose& pose, const JointLimits& limits);

/// The pose `trunk` with arms whose elbows and wrists are on the viewing rays on which `pose` of the body
/// `from` has them, as in carry_pose.
Pose carry_arms(const Body& from, const Pose& pose, const Body& to, const Pose& trunk,
                const JointLimits& limits);

/// Fits limb lengths, shoulder width, girths and sleeve to several frames at once, each with its own pose. In
/// one frame limbs are foreshortened and a straight arm hides its elbow; several frames with different poses
/// determine the lengths. Keyframes are processed in parallel; the result does not depend on the number of
/// threads. Returns `shape` when nothing better is found.
ShapeRefinement refine_shape(const BackendMaker& make_backend, std::span<const Keyframe> keyframes,
                             const Shape& shape, const JointLimits& limits, const ShapeFitConfig& spreads,
                             const ShapeRefineConfig& config);

}  // namespace telemime
