// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/shape_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "telemime/body/arm_ik.h"
#include "telemime/body/arm_parts.h"
#include "telemime/core/square.h"
#include "telemime/search/simplex.h"

namespace telemime {
namespace {

struct Candidate {
  Shape shape;
  Pose pose;
};

// Numbers that are fitted together. They are added to logarithms of scales, to the sleeve or to the
// translation.
struct Group {
  std::vector<double> steps;
  std::vector<double> reach;  // largest change of each
  std::function<Candidate(const Candidate&, const Eigen::VectorXd&)> apply;
};

void scale(SegmentScale& s, double length, double height, double width) {
  s.length *= std::exp(length);
  s.height *= std::exp(height);
  s.width *= std::exp(width);
}

// With `joints` the shoulder joints are fitted apart from the outline of the chest.
Group trunk_group(bool joints) {
  Group group;
  group.steps = {0.02, 0.02, 0.04, 0.05, 0.05, 0.05};
  group.reach = {0.3, 0.3, 0.4, 0.3, 0.3, 0.4};
  if (joints) {
    group.steps.push_back(0.05);
    group.reach.push_back(0.4);
  }
  group.apply = [joints](const Candidate& from, const Eigen::VectorXd& x) {
    Candidate to = from;
    to.pose.root += Eigen::Vector3d(x[0], x[1], x[2]);
    scale(to.shape[Segment::chest], x[3], x[4], x[5]);
    to.shape.shoulders *= joints ? std::exp(x[6]) : 1.0;
    return to;
  };
  return group;
}

Group head_group() {
  return {{0.05, 0.05, 0.05}, {0.3, 0.3, 0.3}, [](const Candidate& from, const Eigen::VectorXd& x) {
            Candidate to = from;
            scale(to.shape[Segment::head], x[0], x[1], x[2]);
            return to;
          }};
}

// How far a relaxed forearm points toward the camera when the arms are held parallel to the image.
constexpr double kRelaxedSlope = 15.0 * std::numbers::pi / 180.0;

// Lays an arm parallel to the image plane: its in-plane directions are those of the pose turned by two
// angles; the forearm slopes a little towards the camera. Lengths and directions can then be fitted together
// without the foreshortening that would hide a wrong length.
void flatten_arm(const Body& body, const JointLimits& limits, Side side, double turn_upper, double turn_fore,
                 Pose& pose) {
  const auto i = static_cast<std::size_t>(side);
  const ArmParts& arm = arm_parts(side);
  const Kinematics k = forward_kinematics(body, pose);
  const Eigen::Vector3d& shoulder = k.joints[arm.shoulder];
  const Eigen::Vector3d& elbow = k.joints[arm.elbow];
  const Eigen::Vector3d& wrist = k.joints[arm.wrist];
  const auto in_plane = [](const Eigen::Vector3d& along, double turn) {
    const double a = std::atan2(along.y(), along.x()) + turn;
    return Eigen::Vector3d(std::cos(a), std::sin(a), 0.0);
  };
  const Eigen::Vector3d upper = in_plane(elbow - shoulder, turn_upper);
  const Eigen::Vector3d fore = in_plane(wrist - elbow, turn_fore) * std::cos(kRelaxedSlope) -
                               Eigen::Vector3d::UnitZ() * std::sin(kRelaxedSlope);
  const Eigen::Vector3d new_elbow = shoulder + upper * body.upper_arm_length[i];
  set_arm_angles(pose, side,
                 arm_through(body, pose, side, new_elbow, new_elbow + fore * body.forearm_length[i], limits));
}

constexpr std::array<Side, 2> kSides = {Side::left, Side::right};

// Girths of the arms and the sleeve. Left and right limbs have the same scales.
Group arm_girths_group() {
  return {
      {0.10, 0.10, 0.10, 0.15}, {0.6, 0.6, 0.5, 2.0}, [](const Candidate& from, const Eigen::VectorXd& x) {
        Candidate to = from;
        for (const ArmParts& arm : kArmParts) {
          scale(to.shape[arm.upper_arm], 0.0, x[0], x[0]);
          scale(to.shape[arm.forearm], 0.0, x[1], x[1]);
          scale(to.shape[arm.hand], 0.0, x[2], x[2]);
        }
        to.shape.sleeve = std::clamp(from.shape.sleeve + x[3], 0.0, 2.0);
        return to;
      }};
}

// The same with the lengths of the arms. Left and right limbs have the same scales.
Group arms_group(const JointLimits& limits) {
  Group group;
  group.steps = {0.05, 0.10, 0.05, 0.10, 0.05, 0.10, 0.15};
  group.reach = {0.3, 0.6, 0.3, 0.6, 0.3, 0.5, 2.0};
  for (std::size_t i = 0; i < 2 * kSides.size(); ++i) {
    group.steps.push_back(0.06);
    group.reach.push_back(0.6);
  }
  group.apply = [&limits](const Candidate& from, const Eigen::VectorXd& x) {
    Candidate to = from;
    for (const ArmParts& arm : kArmParts) {
      scale(to.shape[arm.upper_arm], x[0], x[1], x[1]);
      scale(to.shape[arm.forearm], x[2], x[3], x[3]);
      scale(to.shape[arm.hand], x[4], x[5], x[5]);
    }
    to.shape.sleeve = std::clamp(from.shape.sleeve + x[6], 0.0, 2.0);
    const Body body = make_body(to.shape);
    for (std::size_t i = 0; i < kSides.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(7 + 2 * i);
      flatten_arm(body, limits, kSides[i], x[at], x[at + 1], to.pose);
    }
    return to;
  };
  return group;
}

}  // namespace

double shoulder_prior(const Shape& shape, const ShapeFitConfig& config) {
  return square(std::log(shape.shoulders * shape[Segment::chest].width) / config.length_spread);
}

double shape_prior(const Shape& shape, const ShapeFitConfig& config) {
  double sum = 0.0;
  for (const SegmentScale& s : shape.segments) {
    sum += square(std::log(s.length) / config.length_spread) +
           square(std::log(s.height) / config.girth_spread) + square(std::log(s.width) / config.girth_spread);
  }
  sum /= static_cast<double>(3 * kSegmentCount);
  // A nearly straight arm shows its whole length but not where the elbow is: average proportions decide.
  for (const ArmParts& arm : kArmParts) {
    sum += square(std::log(shape[arm.upper_arm].length / shape[arm.forearm].length) / config.ratio_spread);
  }
  return sum;
}

ShapeFit fit_shape(Backend& backend, const PreparedFrame& frame, const Shape& shape, const Pose& pose,
                   const JointLimits& limits, const ShapeFitConfig& config) {
  const std::array<Group, 3> groups = {trunk_group(frame.landmarks.has_value()), head_group(),
                                       frame.landmarks ? arm_girths_group() : arms_group(limits)};
  Candidate best = {shape, pose};
  CueValues weights = step_weights(backend.cues(), &Cue::edge_step);
  weights[cue::kContour] = config.contour_weight;
  ShapeFit fit;
  for (const Group& group : groups) {
    // Cost of a change: all cues, and the deviation from the average body.
    const auto n = static_cast<Eigen::Index>(group.steps.size());
    const Eigen::VectorXd steps = Eigen::Map<const Eigen::VectorXd>(group.steps.data(), n);
    const Eigen::VectorXd reach = Eigen::Map<const Eigen::VectorXd>(group.reach.data(), n);
    const auto cost = [&](const Eigen::VectorXd& x) {
      const Candidate c = group.apply(best, x);
      const Model model = make_model(c.shape);
      Score s;
      backend.evaluate(frame, model, {&c.pose, 1}, backend.cues().needs(), {&s, 1});
      const double joints =
          frame.landmarks ? shoulder_prior(c.shape, config) / static_cast<double>(3 * kSegmentCount) : 0.0;
      return add_cue_costs(0.0, backend, frame, weights, s) +
             config.prior_weight * (shape_prior(c.shape, config) + joints);
    };
    // Minimise it, and continue from the result with the next group.
    SimplexOptions options;
    options.max_evaluations = config.iterations * static_cast<int>(n) / 6;
    const Bounds bounds = {-reach, reach};
    const SimplexResult found =
        minimise(cost, axis_simplex(Eigen::VectorXd::Zero(n), steps, bounds), bounds, options);
    best = group.apply(best, found.best().point);
    fit.cost = found.best().cost;
    fit.evaluations += found.evaluations;
  }
  fit.shape = best.shape;
  fit.pose = best.pose;
  return fit;
}

}  // namespace telemime
