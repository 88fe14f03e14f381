// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "telemime/search/shape_fit.h"

namespace telemime {

/// Settings of refine_shape.
struct ShapeRefineConfig {
  int keyframes = 8;             ///< frames that the shape is fitted to at once
  int rounds = 2;                ///< over all lengths, each with half the step of the one before
  int pose_iterations = 100;     ///< evaluations that each arm of each keyframe gets for each length tried
  int shapes = 60;               ///< girths and sleeves that are tried in each round
  double contour_weight = 0.15;  ///< of D_C beside F
  double natural_weight = 0.02;  ///< of natural_cost in each keyframe
  double prior_weight = 0.002;   ///< of the squared deviations (over their spreads) from average arms
};

/// A frame with the pose that was found in it.
struct Keyframe {
  PreparedFrame frame;
  Pose pose;
  double region = 0.0;  ///< F of the pose
};

struct ShapeRefinement {
  Shape shape;
  std::vector<Pose> poses;  ///< of the keyframes, for the new shape
  double cost_before = 0.0;
  double cost = 0.0;  ///< mean over the keyframes, prior included
  int evaluations = 0;
};

using BackendMaker = std::function<std::unique_ptr<Backend>()>;

/// Are elbows, wrists and hands inside the image?
bool shows_arms(const Body& body, const Keyframe& keyframe);

/// Picks at most `count` of the candidates: the first good one, then always the one whose arms are farthest
/// from those picked. Good ones show both arms and do not fit much worse than the others. Returns their
/// indices in rising order.
std::vector<std::size_t> pick_keyframes(const Body& body, std::span<const Keyframe> candidates,
                                        std::size_t count);

/// The pose with the same trunk for another body: elbows and wrists stay on their viewing rays, at the depth
/// that the new lengths ask for, on the side (nearer or farther than their parent joint) on which they were.
Pose carry_pose(const Body& from, const Body& to, const Pose& pose, const JointLimits& limits);

/// `trunk` with its arms laid so that elbows and wrists stay on the viewing rays on which `pose` of the body
/// `from` has them, as carry_pose does.
Pose carry_arms(const Body& from, const Pose& pose, const Body& to, const Pose& trunk,
                const JointLimits& limits);

/// Fits limb lengths, shoulder width, girths and sleeve to several frames at once, each with a pose of its
/// own. One frame shows a limb foreshortened and a straight arm hides where its elbow is; frames with
/// different poses together do not. Keyframes are worked on in parallel; the result
/// does not depend on the number of threads. `shape` comes back when nothing better is found.
ShapeRefinement refine_shape(const BackendMaker& make_backend, std::span<const Keyframe> keyframes,
                             const Shape& shape, const JointLimits& limits, const ShapeFitConfig& spreads,
                             const ShapeRefineConfig& config);

}  // namespace telemime
