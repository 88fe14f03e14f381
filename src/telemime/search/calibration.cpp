// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/calibration.h"

#include <algorithm>
#include <cmath>

#include "telemime/body/arm_parts.h"
#include "telemime/search/landmark_fit.h"

namespace telemime {
namespace {

// The head of the model at 1.70 m, from the neck (mesh.cpp): chin at 0.030, crown with hair at 0.271, centre
// 0.045 ahead.
constexpr double kChin = 0.030;
constexpr double kCrown = 0.271;
constexpr double kAhead = 0.045;
constexpr double kDesignStature = 1.70;

// A joint nearer to the camera than this cannot be measured.
constexpr double kTooNear = 0.1;  // m
// A hand between the shoulders is in front of the body, except for this share of their distance at both
// sides.
constexpr double kBesideBody = 0.1;
// The first frame tries distances of the head, each this factor from the next, kDistances to both sides.
constexpr double kDistanceFactor = 1.035;
constexpr int kDistances = 6;
constexpr double kDistanceCost = 0.05;  // of the farthest of them, beside the share of pixels that differ
constexpr double kArmsAside = 0.3;      // rad, abduction and flexion of the elbows meanwhile

ObjectiveWeights search_weights(const CueTable& cues) {
  return {.cues = step_weights(cues, &Cue::edge_step), .natural = 0.04};
}

// Registration without a prediction from earlier frames.
RegistrationConfig alignment(const RegistrationConfig& registration, int iterations, double fronto_parallel) {
  RegistrationConfig config = registration;
  config.iterations = iterations;
  for (ObjectiveWeights* w : {&config.region, &config.edge}) {
    w->temporal = 0.0;
    w->trunk = 0.0;
    w->fronto_parallel = fronto_parallel;
  }
  return config;
}

struct HeadGeometry {
  double half_height;
  Eigen::Vector3d centre_from_root;  // body frame
};

HeadGeometry head_geometry(const Body& body) {
  const double size = body.shape.stature / kDesignStature;
  const SegmentScale& s = body.shape[Segment::head];
  return {0.5 * (kCrown - kChin) * size * s.length,
          body.neck_from_root +
              Eigen::Vector3d(0.0, 0.5 * (kCrown + kChin) * size * s.length, kAhead * size * s.height)};
}

// The pose that explains the frame's landmarks and fits the image best; empty without landmarks.
std::optional<Pose> best_landmark_pose(Objective& objective, const ObjectiveWeights& weights) {
  constexpr std::size_t kMost = 8;
  const auto& landmarks = objective.frame().landmarks;
  const Body& body = objective.model().body;
  const Camera& camera = objective.frame().camera;
  const auto start =
      landmarks ? pose_from_landmarks(body, camera, *landmarks, objective.limits()) : std::nullopt;
  if (!start) {
    return std::nullopt;
  }
  std::optional<Pose> best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (const LandmarkFit& fit :
       landmark_proposals(body, camera, *landmarks, {.pose = *start}, objective.limits(), kMost)) {
    const double cost = objective(fit.pose, weights);
    if (cost < best_cost) {
      best = fit.pose;
      best_cost = cost;
    }
  }
  return best;
}

// Why the arm cannot be fitted: a part of it is outside the image or in front of the chest. Empty: it can.
std::string arm_problem(const Model& model, const Pose& pose, const Camera& camera, Side side) {
  const Kinematics k = forward_kinematics(model.body, pose);
  const ArmParts& arm = arm_parts(side);
  const std::string name = side == Side::left ? "left" : "right";
  const Eigen::Vector2d l = camera.project(k.joints[Joint::l_shoulder]);
  const Eigen::Vector2d r = camera.project(k.joints[Joint::r_shoulder]);
  for (const Joint j : {arm.elbow, arm.wrist}) {
    if (k.joints[j].z() < kTooNear) {
      return "the " + name + " arm is too near the camera";
    }
    const Eigen::Vector2d p = camera.project(k.joints[j]);
    if (p.x() < 0 || p.y() < 0 || p.x() > camera.width - 1 || p.y() > camera.height - 1) {
      return "the " + name + " arm leaves the image";
    }
    const double low = std::min(l.x(), r.x());
    const double high = std::max(l.x(), r.x());
    const double margin = kBesideBody * (high - low);
    if (j == arm.wrist && p.x() > low + margin && p.x() < high - margin) {
      return "the " + name + " hand is in front of the body";
    }
  }
  return {};
}

}  // namespace

SettingTable settings_of(CalibrationConfig& c) {
  SettingTable table;
  table.rows = {
      number("height", &c.stature, {0.8, 2.5}, "m",
             "Height of the person, which sets the absolute scale; null: an average head sets it."),
      number("calibration.nearest", &c.nearest, {0.1, 50}, "m", "Smallest distance of a person."),
      number("calibration.farthest", &c.farthest, {0.1, 50}, "m", "Largest distance of a person."),
      number("calibration.arm_samples", &c.arms.samples, {0, 1000000}, "",
             "Random arms that are evaluated in the first frame."),
      number("calibration.arm_kept", &c.arms.kept, {1, 1000000}, "", "Best random arms that are refined."),
      number("calibration.arm_refine", &c.arms.refine, {1, 1000000}, "evaluations",
             "Effort of each of these refinements."),
      number("calibration.rounds", &c.rounds, {1, 20}, "",
             "Rounds of pose alignment and shape adjustment in the first frame."),
      number("calibration.pose_iterations", &c.pose_iterations, {10, 1000000}, "evaluations",
             "Effort of each pose alignment."),
      number("calibration.shape_iterations", &c.shape.iterations, {10, 1000000}, "evaluations",
             "Effort of fitting six numbers of the shape; more numbers get more in proportion."),
      number("calibration.fronto_parallel", &c.fronto_parallel, {0, 1e6}, "",
             "Weight of the assumption that the arms are parallel to the image."),
      number("calibration.worst_region", &c.worst_region, {0.01, 1}, "F",
             "Largest F of a first frame from which the arms are measured."),
      number("calibration.length_spread", &c.shape.length_spread, {1e-6, 10}, "",
             "Standard deviation of the logarithm of segment lengths over people."),
      number("calibration.girth_spread", &c.shape.girth_spread, {1e-6, 10}, "",
             "Standard deviation of the logarithm of segment widths and heights over people."),
      number("calibration.ratio_spread", &c.shape.ratio_spread, {1e-6, 10}, "",
             "Standard deviation of the logarithm of upper arm over forearm length over people."),
      number("calibration.prior_weight", &c.shape.prior_weight, {0, 1e6}, "",
             "Weight of average proportions in the fit to the first frame."),
      number("calibration.contour_weight", &c.shape.contour_weight, {0, 1e6}, "",
             "Weight of D_C beside F in all fits of the shape."),
      number("calibration.look_ahead", &c.look_ahead, {0, 1000}, "1/25 s",
             "Time in a file from which the keyframes are chosen; 0: the shape is fitted to the first good "
             "frame only."),
      number("calibration.keyframes", &c.refine.keyframes, {1, 100}, "frames",
             "Number of keyframes beside the first frame; the first alone counts if fewer than 3 are found."),
      number("calibration.refine_rounds", &c.refine.rounds, {0, 20}, "",
             "Rounds over all lengths and girths, each with half the step of the one before."),
      number("calibration.refine_iterations", &c.refine.pose_iterations, {10, 10000}, "evaluations",
             "Effort for each arm of each keyframe and each length."),
      number("calibration.refine_shapes", &c.refine.shapes, {0, 10000}, "",
             "Girths and sleeves that are evaluated in each round."),
      number("calibration.refine_prior_weight", &c.refine.prior_weight, {0, 1e6}, "",
             "Weight of average proportions in the fit to the keyframes."),
      number("calibration.refine_natural_weight", &c.refine.natural_weight, {0, 1e6}, "",
             "Weight of natural poses in the fit to the keyframes."),
  };
  table.rules = {{c.nearest < c.farthest, "calibration.nearest must be below calibration.farthest"}};
  return table;
}

Pose place_at_head(const Body& body, const HeadRegion& head, const Camera& camera) {
  const HeadGeometry g = head_geometry(body);
  const double z = camera.fy * g.half_height / std::max(1.0, head.radii.y());
  Pose pose;
  pose.root = camera.ray(head.centre) * z - camera_from_body_at_rest() * g.centre_from_root;
  return pose;
}

Pose initialise_pose(Objective& objective, const HeadRegion& head, const CalibrationConfig& config,
                     const RegistrationConfig& registration, Random& random) {
  const Body& body = objective.model().body;
  const Camera& camera = objective.frame().camera;
  const HeadGeometry g = head_geometry(body);
  const ObjectiveWeights weights = search_weights(objective.cues());
  // With landmarks: the cheapest of the poses that explain them.
  if (const std::optional<Pose> seen = best_landmark_pose(objective, weights)) {
    return register_pose(objective, *seen, alignment(registration, config.pose_iterations, 0.0), random).pose;
  }
  const Pose placed = place_at_head(body, head, camera);
  const double z_head = placed.root.z() - g.centre_from_root.z();
  // Translation (thesis 3.3): the distance near the one from the head's height at which head and clothes
  // overlap best. The arms are not known yet, so they do not count.
  Pose best = placed;
  double best_cost = std::numeric_limits<double>::infinity();
  for (int i = -kDistances; i <= kDistances; ++i) {
    const double z = std::clamp(z_head * std::pow(kDistanceFactor, i), config.nearest, config.farthest);
    Pose pose = placed;
    pose.root = camera.ray(head.centre) * z - camera_from_body_at_rest() * g.centre_from_root;
    set_arm_angles(pose, Side::left, {0.0, 0.0, kArmsAside, -kArmsAside});
    set_arm_angles(pose, Side::right, {0.0, 0.0, -kArmsAside, -kArmsAside});
    const Score s = objective.score(pose, Reduction::overlap);
    double cost = kDistanceCost * std::abs(static_cast<double>(i)) / kDistances;
    for (const std::size_t c : {std::size_t{0}, std::size_t{2}}) {
      const int either = s.reductions.observed[c] + s.reductions.model[c] - s.reductions.both[c];
      cost += either > 0 ? 0.5 * (either - s.reductions.both[c]) / either : 0.0;
    }
    if (cost < best_cost) {
      best_cost = cost;
      best = pose;
    }
  }
  // Pose: each arm globally, twice, since they can cover each other; then all numbers together.
  for (int round = 0; round < 2; ++round) {
    ArmSearchConfig arms = config.arms;
    arms.samples = round == 0 ? arms.samples : arms.samples / 4;
    best = search_arm(objective, best, Side::left, weights, arms, random);
    best = search_arm(objective, best, Side::right, weights, arms, random);
  }
  return register_pose(objective, best, alignment(registration, config.pose_iterations, 0.0), random).pose;
}

Calibration calibrate(Backend& backend, const PreparedFrame& frame, const HeadRegion& head,
                      const JointLimits& limits, const CalibrationConfig& config,
                      const RegistrationConfig& registration, Random& random) {
  Calibration result;
  // Landmarks see the arms' depth; without them the arms are assumed to be parallel to the image.
  const double fronto_parallel = frame.landmarks ? 0.0 : config.fronto_parallel;
  result.shape.stature = config.stature.value_or(kDesignStature);
  // Translation and pose with the average body.
  Model model = make_model(result.shape);
  {
    Objective objective(backend, frame, model, limits);
    result.pose = initialise_pose(objective, head, config, registration, random);
    result.pose = register_pose(objective, result.pose,
                                alignment(registration, config.pose_iterations, fronto_parallel), random)
                      .pose;
    result.evaluations += objective.evaluations();
  }
  // Shape adjustment and pose alignment in turn.
  const RegistrationConfig align = alignment(registration, config.pose_iterations, fronto_parallel);
  const int rounds = frame.has_colours ? config.rounds : 0;
  for (int round = 0; round < rounds; ++round) {
    const ShapeFit fit = fit_shape(backend, frame, result.shape, result.pose, limits, config.shape);
    result.evaluations += fit.evaluations;
    result.shape = fit.shape;
    model = make_model(result.shape);
    Objective objective(backend, frame, model, limits);
    const RegistrationResult registered = register_pose(objective, fit.pose, align, random);
    result.pose = registered.pose;
    result.score = registered.score;
    result.evaluations += objective.evaluations();
  }
  if (rounds == 0) {
    Objective objective(backend, frame, model, limits);
    result.score = objective.score(result.pose, objective.cues().needs());
  }
  // Whether this frame shows what the fit needs.
  for (const Side side : {Side::left, Side::right}) {
    if (result.refusal.empty()) {
      result.refusal = arm_problem(model, result.pose, frame.camera, side);
    }
  }
  // A head without a face may be in profile.
  constexpr double kFaceless = 0.85;
  const double worst = config.worst_region * (head.detected ? 1.0 : kFaceless);
  if (result.refusal.empty() && result.score.region() > worst) {
    result.refusal = "the body does not fit the image (F " + std::to_string(result.score.region()) + ")";
  }
  return result;
}

}  // namespace telemime
