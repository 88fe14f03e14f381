// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/shape_refine.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "telemime/body/arm_parts.h"
#include "telemime/core/square.h"
#include "telemime/search/arm_search.h"

namespace telemime {
namespace {

using ArmPoints = Eigen::Matrix<double, 3, 4>;

// Elbows and wrists relative to the middle of the shoulders, m.
ArmPoints arm_points(const Body& body, const Pose& pose) {
  const JointPositions j = forward_kinematics(body, pose).joints;
  const Eigen::Vector3d middle = mid_shoulders(j);
  ArmPoints points;
  points << j[Joint::l_elbow], j[Joint::l_wrist], j[Joint::r_elbow], j[Joint::r_wrist];
  return points.colwise() - middle;
}

// The point at the distance `length` from `parent` on the viewing ray of `seen`, on the same side of `parent`
// as `seen`. When the ray passes too far away: the point of that sphere nearest to the ray.
Eigen::Vector3d on_ray(const Eigen::Vector3d& seen, const Eigen::Vector3d& old_parent,
                       const Eigen::Vector3d& parent, double length) {
  const Eigen::Vector3d ray = seen.normalized();
  const double along = ray.dot(parent);
  const Eigen::Vector3d foot = ray * along;
  const double across = (foot - parent).norm();
  if (across >= length) {
    return parent + (foot - parent) * (length / across);
  }
  const double half = std::sqrt(length * length - across * across);
  const double side = seen.dot(ray) < ray.dot(old_parent) ? -1.0 : 1.0;
  return ray * (along + side * half);
}

// Changes the logarithms of a segment's length and girth on both sides.
void both(Shape& shape, Segment ArmParts::*segment, double length, double girth) {
  for (const ArmParts& arm : kArmParts) {
    SegmentScale& s = shape[arm.*segment];
    s.length *= std::exp(length);
    s.height *= std::exp(girth);
    s.width *= std::exp(girth);
  }
}

// Changes of lengths that are searched one after the other: the whole arm, its division into upper arm and
// forearm, the hand, the shoulders.
using LengthChange = void (*)(Shape&, double);
constexpr std::array<std::pair<LengthChange, double>, 4> kLengths = {{
    {[](Shape& s, double x) {
       both(s, &ArmParts::upper_arm, x, 0.0);
       both(s, &ArmParts::forearm, x, 0.0);
     },
     0.06},
    {[](Shape& s, double x) {
       both(s, &ArmParts::upper_arm, 0.5 * x, 0.0);
       both(s, &ArmParts::forearm, -0.5 * x, 0.0);
     },
     0.08},
    {[](Shape& s, double x) { both(s, &ArmParts::hand, x, 0.0); }, 0.10},
    {[](Shape& s, double x) { s[Segment::chest].width *= std::exp(x); }, 0.04},
}};
// With landmarks the shoulder joints move and the chest stays.
constexpr std::pair<LengthChange, double> kShoulders = {
    [](Shape& s, double x) { s.shoulders *= std::exp(x); }, 0.04};

// Changes the logarithms of the girths of upper arm, forearm and hand, and the end of the sleeve.
Shape with_girths(const Shape& from, const Eigen::Vector4d& x) {
  Shape to = from;
  both(to, &ArmParts::upper_arm, 0.0, x[0]);
  both(to, &ArmParts::forearm, 0.0, x[1]);
  both(to, &ArmParts::hand, 0.0, x[2]);
  to.sleeve = std::clamp(from.sleeve + x[3], 0.0, 2.0);
  return to;
}

// A shape and the best poses that were found with it.
struct Fitted {
  Shape shape;
  std::vector<Pose> poses;
  double cost = std::numeric_limits<double>::infinity();
};

class Refiner {
 public:
  Refiner(const BackendMaker& make_backend, std::span<const Keyframe> keyframes, const JointLimits& limits,
          const ShapeFitConfig& spreads, const ShapeRefineConfig& config)
      : keyframes_(keyframes), limits_(limits), spreads_(spreads), config_(config) {
    for (std::size_t i = 0; i < keyframes.size(); ++i) {
      backends_.push_back(make_backend());
      landmarks_ = landmarks_ || keyframes[i].frame.landmarks;
    }
  }

  // Evaluates a shape. Each keyframe starts from its pose in `from`, carried over or with the same angles,
  // whichever fits better; with `iterations` > 0 each arm is then searched.
  Fitted fit(const Fitted& from, const Shape& shape, int iterations) {
    const Model model = make_model(shape);
    const Body old_body = make_body(from.shape);
    Fitted fitted;
    fitted.shape = shape;
    fitted.poses.resize(keyframes_.size());
    std::vector<double> costs(keyframes_.size());
    std::vector<int> evaluations(keyframes_.size());
    tbb::parallel_for(std::size_t{0}, keyframes_.size(), [&](std::size_t i) {
      Objective objective(*backends_[i], keyframes_[i].frame, model, limits_);
      const ScoredPose best = best_pose(
          objective, {from.poses[i], carry_pose(old_body, model.body, from.poses[i], limits_)}, iterations);
      fitted.poses[i] = best.pose;
      costs[i] = best.cost;
      evaluations[i] = objective.evaluations();
    });
    fitted.cost = prior(shape);
    for (std::size_t i = 0; i < costs.size(); ++i) {
      fitted.cost += costs[i] / static_cast<double>(costs.size());
      evaluations_ += evaluations[i];
    }
    return fitted;
  }

  int evaluations() const { return evaluations_; }
  bool landmarks() const { return landmarks_; }

 private:
  // Proportions of arms vary less over people than estimates from single frames do.
  double prior(const Shape& shape) const {
    const SegmentScale& upper = shape[Segment::l_upper_arm];
    const SegmentScale& fore = shape[Segment::l_forearm];
    const SegmentScale& hand = shape[Segment::l_hand];
    double sum = square(std::log(upper.length / fore.length) / spreads_.ratio_spread) +
                 square(std::log(shape[Segment::chest].width) / spreads_.girth_spread);
    sum += landmarks_ ? shoulder_prior(shape, spreads_) : 0.0;
    for (const SegmentScale* s : {&upper, &fore, &hand}) {
      sum += square(std::log(s->length) / spreads_.length_spread) +
             square(std::log(s->width) / spreads_.girth_spread);
    }
    return config_.prior_weight * sum;
  }

  ScoredPose best_pose(Objective& objective, const std::array<Pose, 2>& starts, int iterations) const {
    ObjectiveWeights weights{.cues = step_weights(objective.cues(), &Cue::edge_step),
                             .natural = config_.natural_weight};
    weights.cues[cue::kContour] = spreads_.contour_weight;
    ScoredPose best = {starts[0], objective(starts[0], weights)};
    if (const double other = objective(starts[1], weights); other < best.cost) {
      best = {starts[1], other};
    }
    if (iterations == 0) {
      return best;
    }
    for (const Side side : {Side::left, Side::right}) {
      const SearchBlock block = bones_block(objective.model().body, best.pose, side, limits_, 1.0);
      best = search_block(objective, best, block, weights, iterations);
    }
    return best;
  }

  std::span<const Keyframe> keyframes_;
  const JointLimits& limits_;
  const ShapeFitConfig& spreads_;
  const ShapeRefineConfig& config_;
  std::vector<std::unique_ptr<Backend>> backends_;
  int evaluations_ = 0;
  bool landmarks_ = false;
};

// Minimum of the least-squares parabola through the costs at -2, -1, 0, 1, 2, within that range. The costs
// are noisy, because the searches of the poses end early; the parabola smooths them.
double minimum_of_parabola(const std::array<double, 5>& cost) {
  const double slope = (-2.0 * cost[0] - cost[1] + cost[3] + 2.0 * cost[4]) / 10.0;
  const double bend = (2.0 * cost[0] - cost[1] - 2.0 * cost[2] - cost[3] + 2.0 * cost[4]) / 14.0;
  const auto lowest = std::distance(cost.begin(), std::min_element(cost.begin(), cost.end()));
  return bend > 0.0 ? std::clamp(-0.5 * slope / bend, -2.0, 2.0) : static_cast<double>(lowest - 2);
}

Fitted search_length(Refiner& refiner, const Fitted& from, LengthChange change, double step, int iterations) {
  const auto at = [&](double x) {
    Shape shape = from.shape;
    change(shape, x * step);
    return refiner.fit(from, shape, iterations);
  };
  std::array<Fitted, 5> tried;
  std::array<double, 5> costs{};
  for (std::size_t i = 0; i < tried.size(); ++i) {
    tried[i] = at(static_cast<double>(i) - 2.0);
    costs[i] = tried[i].cost;
  }
  Fitted between = at(minimum_of_parabola(costs));
  const auto lowest = std::min_element(costs.begin(), costs.end()) - costs.begin();
  return between.cost <= costs[static_cast<std::size_t>(lowest)] ? between
                                                                 : tried[static_cast<std::size_t>(lowest)];
}

// Girths move no joint, so the poses are not searched again.
Fitted search_girths(Refiner& refiner, const Fitted& from, double step, int shapes) {
  const Eigen::VectorXd reach = Eigen::Vector4d(0.5, 0.5, 0.5, 1.0);
  const Bounds bounds = {-reach, reach};
  SimplexOptions options;
  options.max_evaluations = shapes;
  const auto at = [&](const Eigen::VectorXd& x) { return refiner.fit(from, with_girths(from.shape, x), 0); };
  const SimplexResult found = minimise(
      [&](const Eigen::VectorXd& x) { return at(x).cost; },
      axis_simplex(Eigen::VectorXd::Zero(4), Eigen::VectorXd::Constant(4, step), bounds), bounds, options);
  return at(found.best().point);
}

}  // namespace

constexpr double kNearestJoint = 0.1;  // m, distance of a joint that can be seen
constexpr double kWorst = 1.1;         // F of a keyframe, over the median of all candidates

bool shows_arms(const Body& body, const Keyframe& keyframe) {
  const Camera& camera = keyframe.frame.camera;
  const JointPositions joints = forward_kinematics(body, keyframe.pose).joints;
  for (const Joint j :
       {Joint::l_elbow, Joint::l_wrist, Joint::l_hand, Joint::r_elbow, Joint::r_wrist, Joint::r_hand}) {
    const Eigen::Vector2d p =
        joints[j].z() > kNearestJoint ? camera.project(joints[j]) : Eigen::Vector2d(-1.0, -1.0);
    if (p.x() < 0.0 || p.y() < 0.0 || p.x() > camera.width - 1 || p.y() > camera.height - 1) {
      return false;
    }
  }
  return true;
}

std::vector<std::size_t> pick_keyframes(const Body& body, std::span<const Keyframe> candidates,
                                        std::size_t count) {
  std::vector<std::size_t> picked;
  if (candidates.empty() || count == 0) {
    return picked;
  }
  // Good candidates: both arms visible, and F not far above the median.
  std::vector<double> regions;
  std::vector<ArmPoints> points;
  for (const Keyframe& k : candidates) {
    regions.push_back(k.region);
    points.push_back(arm_points(body, k.pose));
  }
  const auto middle = regions.begin() + static_cast<std::ptrdiff_t>(regions.size() / 2);
  std::nth_element(regions.begin(), middle, regions.end());
  const double worst = kWorst * *middle;
  std::vector<double> distance(candidates.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].region > worst || !shows_arms(body, candidates[i])) {
      distance[i] = 0.0;
    } else if (picked.empty()) {
      picked.push_back(i);
    }
  }
  if (picked.empty()) {
    return picked;
  }
  // Farthest-point sampling over the positions of the arms.
  while (picked.size() < count) {
    std::size_t farthest = picked.front();
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      distance[i] = std::min(distance[i], (points[i] - points[picked.back()]).squaredNorm());
      if (distance[i] > distance[farthest]) {
        farthest = i;
      }
    }
    if (distance[farthest] <= 0.0) {
      break;
    }
    picked.push_back(farthest);
  }
  std::sort(picked.begin(), picked.end());
  return picked;
}

Pose carry_pose(const Body& from, const Body& to, const Pose& pose, const JointLimits& limits) {
  return carry_arms(from, pose, to, pose, limits);
}

Pose carry_arms(const Body& from, const Pose& pose, const Body& to, const Pose& trunk,
                const JointLimits& limits) {
  const JointPositions seen = forward_kinematics(from, pose).joints;
  Pose carried = trunk;
  for (const Side side : {Side::left, Side::right}) {
    const auto i = static_cast<std::size_t>(side);
    const ArmParts& arm = arm_parts(side);
    const Eigen::Vector3d origin = forward_kinematics(to, carried).joints[arm.shoulder];
    const Eigen::Vector3d e = on_ray(seen[arm.elbow], seen[arm.shoulder], origin, to.upper_arm_length[i]);
    const Eigen::Vector3d w = on_ray(seen[arm.wrist], seen[arm.elbow], e, to.forearm_length[i]);
    set_arm_angles(carried, side, arm_through(to, carried, side, e, w, limits));
  }
  return limits.clamp(carried);
}

ShapeRefinement refine_shape(const BackendMaker& make_backend, std::span<const Keyframe> keyframes,
                             const Shape& shape, const JointLimits& limits, const ShapeFitConfig& spreads,
                             const ShapeRefineConfig& config) {
  Refiner refiner(make_backend, keyframes, limits, spreads, config);
  Fitted best;
  best.shape = shape;
  for (const Keyframe& k : keyframes) {
    best.poses.push_back(k.pose);
  }
  // Coordinate descent: each length, then all girths, with smaller steps in each round.
  ShapeRefinement result;
  best = refiner.fit(best, shape, config.pose_iterations);
  result.cost_before = best.cost;
  for (int round = 0; round < config.rounds; ++round) {
    const double scale = std::pow(0.5, round);
    for (std::size_t i = 0; i < kLengths.size(); ++i) {
      const auto& [change, step] = i + 1 == kLengths.size() && refiner.landmarks() ? kShoulders : kLengths[i];
      best = search_length(refiner, best, change, scale * step, config.pose_iterations);
    }
    best = search_girths(refiner, best, 0.1 * scale, config.shapes);
  }
  result.shape = best.shape;
  result.poses = best.poses;
  result.cost = best.cost;
  result.evaluations = refiner.evaluations();
  return result;
}

}  // namespace telemime
