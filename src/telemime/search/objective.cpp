// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/objective.h"

#include <algorithm>
#include <array>

#include "telemime/body/arm_ik.h"
#include "telemime/body/arm_parts.h"
#include "telemime/body/arm_prior.h"
#include "telemime/body/interpenetration.h"
#include "telemime/body/rotations.h"
#include "telemime/core/square.h"

namespace telemime {
namespace {

double outside_limits(const JointLimits& limits, const Pose& pose) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kAngleCount; ++i) {
    sum += std::max({0.0, limits.min[i] - pose.angles[i], pose.angles[i] - limits.max[i]});
  }
  return sum;
}

// The most that one joint costs, however far from its prediction: a lost joint must be able to return.
constexpr double kMostDistance = 2.0;

// Changes between two frames that cost 1: of an elbow or wrist, of the root, and of an angle of trunk or
// neck.
constexpr double kArmChange = 0.15;    // m
constexpr double kRootChange = 0.03;   // m
constexpr double kBendChange = 0.1;    // rad
constexpr double kFastestAngle = 1.2;  // rad in 1/25 s, of shoulder and elbow
// Depth of an elbow or wrist relative to its shoulder that costs 1 in the first frame.
constexpr double kFrontoParallel = 0.1;  // m

// Zones of convenient reach (ArmPrior::reach), as shares of the arm's length.
constexpr double kWristBehind = 0.25;    // behind the shoulder: costs 1
constexpr double kElbowBehind = 0.35;    // the same of the elbow
constexpr double kForearmForward = 0.1;  // of the forearm's length: less is unusual
constexpr double kForearmBehind = 0.3;   // by which it is less: costs 1
constexpr double kUsualReach = 0.3;      // of the wrist before the shoulder

// Angles that cost 1 (rad), about a third of the range of motion.
constexpr double kTorsion = 0.5, kRoll = 0.25, kTilt = 0.3;                   // of the trunk
constexpr double kNeckTorsion = 0.6, kNeckRoll = 0.3, kNeckTilt = 0.3;        // of the neck
constexpr double kWristFlexion = 0.5, kWristPivot = 0.25, kWristTwist = 1.0;  // of the wrists
// Their weights; the neck has 1.
constexpr double kTrunkWeight = 0.3, kWristWeight = 0.5, kTwistWeight = 0.1;

double trunk_change(const Pose& pose, const Pose& predicted) {
  double sum = (pose.root - predicted.root).squaredNorm() / square(kRootChange);
  sum += square(wrap_angle(pose[Angle::root_torsion] - predicted[Angle::root_torsion]) / kBendChange);
  for (const Angle a :
       {Angle::root_roll, Angle::root_tilt, Angle::neck_torsion, Angle::neck_roll, Angle::neck_tilt}) {
    sum += square((pose[a] - predicted[a]) / kBendChange);
  }
  return sum;
}

double depth_of_arms(const Kinematics& k) {
  double sum = 0.0;
  for (const ArmParts& arm : kArmParts) {
    const double shoulder = k.joints[arm.shoulder].z();
    sum += square((k.joints[arm.elbow].z() - shoulder) / kFrontoParallel);
    sum += square((k.joints[arm.wrist].z() - shoulder) / kFrontoParallel);
  }
  return sum / 4.0;
}

// Arms by zones of convenient reach: hands before the chest, low elbows.
double reach_cost(const Body& body, const Kinematics& k) {
  const Eigen::Isometry3d chest_from_camera = k[Segment::chest].inverse();
  const double arm = body.upper_arm_length[0] + body.forearm_length[0];
  double sum = 0.0;
  for (std::size_t side = 0; side < kArmParts.size(); ++side) {
    const Eigen::Vector3d shoulder = chest_from_camera * k.joints[kArmParts[side].shoulder];
    const Eigen::Vector3d elbow = chest_from_camera * k.joints[kArmParts[side].elbow];
    const Eigen::Vector3d wrist = chest_from_camera * k.joints[kArmParts[side].wrist];
    sum += square(std::min(0.0, (wrist.z() - shoulder.z()) / arm) / kWristBehind);
    sum += square(std::min(0.0, (elbow.z() - shoulder.z()) / arm) / kElbowBehind);
    // A forearm that points away from the camera is rare: people gesture towards their listener.
    const double forward = (wrist.z() - elbow.z()) / body.forearm_length[side];
    sum += 2.0 * square(std::min(0.0, forward - kForearmForward) / kForearmBehind);
    sum += 0.2 * square((wrist - shoulder).dot(Eigen::Vector3d::UnitZ()) / arm - kUsualReach);
  }
  return sum;
}

// Share of a frame's prior that is not known from the frame before.
constexpr double kNewEachFrame = 0.5;

}  // namespace

SettingTable settings_of(ObjectiveWeights& w, const std::string& group) {
  const auto weight = [&group](std::string_view name, double& value, const std::string& meaning) {
    return number(group + "." + std::string(name), &value, {0, 1e6}, "", meaning);
  };
  SettingTable table;
  for (std::size_t i = 0; i < kCues.size(); ++i) {
    table.rows.push_back(weight(kCues[i].name, w.cues[i], "Weight of the cue's cost."));
  }
  table.append(
      {{weight("invalid", w.invalid, "Weight of each metre of interpenetration."),
        weight("natural", w.natural, "Weight of natural poses."),
        weight("temporal", w.temporal,
               "Weight of the squared distance (over 0.15 m) of elbows and wrists from their prediction."),
        weight("trunk", w.trunk, "Weight of the squared change (over 0.03 m and 0.1 rad) of the trunk.")},
       {}});
  return table;
}

double distance_from_predicted(const Kinematics& k, const JointPositions& predicted) {
  constexpr std::array<Joint, 4> kArms = {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist, Joint::r_wrist};
  double sum = 0.0;
  for (const Joint j : kArms) {
    const double way = (k.joints[j] - predicted[j]).squaredNorm() / square(kArmChange);
    sum += way / (1.0 + way / kMostDistance);
  }
  return sum / static_cast<double>(kArms.size());
}

Pose predict_pose(const Pose& pose, const Pose& before, double velocity, double time_step,
                  const JointLimits& limits) {
  PoseVector motion = pose.vector() - before.vector();
  motion.head<9>().setZero();
  Pose predicted = Pose::from_vector(pose.vector() + velocity * motion);
  for (const Side side : {Side::left, Side::right}) {
    const ArmAngles now = arm_angles(pose, side);
    const ArmAngles last = arm_angles(before, side);
    const double change =
        std::max({std::abs(now.flexion - last.flexion), std::abs(now.twisting - last.twisting),
                  std::abs(now.abduct - last.abduct), std::abs(now.elbow - last.elbow)});
    if (change > kFastestAngle * time_step) {
      set_arm_angles(predicted, side, now);
    }
  }
  return limits.clamp(predicted);
}

double share_of_motion(double velocity, double time_step, double time_step_before) {
  return std::min(1.0, velocity * time_step / time_step_before);
}

ArmPrior arm_prior_of(const PreparedFrame& frame) {
  return frame.landmarks ? ArmPrior::motion_capture : ArmPrior::reach;
}

double natural_cost(const Body& body, const Pose& pose, const Kinematics& k, double heading, ArmPrior arms) {
  double sum = arms == ArmPrior::reach ? reach_cost(body, k) : kNewEachFrame * 0.5 * arm_rarity(k);
  const auto bend = [&](Angle a, double range) { return square(pose[a] / range); };
  sum += kTrunkWeight * (square(wrap_angle(pose[Angle::root_torsion] - heading) / kTorsion) +
                         bend(Angle::root_roll, kRoll) + bend(Angle::root_tilt, kTilt));
  sum += bend(Angle::neck_torsion, kNeckTorsion) + bend(Angle::neck_roll, kNeckRoll) +
         bend(Angle::neck_tilt, kNeckTilt);
  sum += kWristWeight *
         (bend(Angle::l_wrist_flexion, kWristFlexion) + bend(Angle::r_wrist_flexion, kWristFlexion) +
          bend(Angle::l_wrist_pivot, kWristPivot) + bend(Angle::r_wrist_pivot, kWristPivot));
  sum += kTwistWeight *
         (bend(Angle::l_wrist_twisting, kWristTwist) + bend(Angle::r_wrist_twisting, kWristTwist));
  return sum / 4.0;
}

CueValues step_weights(const CueTable& cues, double Cue::*step) {
  CueValues weights{};
  for (std::size_t i = 0; i < cues.size(); ++i) {
    weights[i] = cues[i].*step;
  }
  return weights;
}

double add_cue_costs(double cost, const Backend& backend, const PreparedFrame& frame,
                     const CueValues& weights, const Score& score) {
  const CueTable& cues = backend.cues();
  for (std::size_t i = 0; i < cues.size(); ++i) {
    const double reliability = weights[i] > 0.0 ? reliability_of(cues[i], frame) : 0.0;
    if (reliability > 0.0) {
      cost += reliability * weights[i] * score.costs[i] / in_cost_units(cues[i], cues[i].scale, frame.camera);
    }
  }
  return cost;
}

Prior prior_at(const Body& body, const Pose& pose, double heading) {
  return {Prior::Prediction{pose, forward_kinematics(body, pose).joints}, heading};
}

Prior prior_between(const Body& body, const Pose& before, const Pose& after, double share, double heading) {
  const JointPositions a = forward_kinematics(body, before).joints;
  const JointPositions b = forward_kinematics(body, after).joints;
  // The objective uses only the trunk of this pose. It may turn all the way round; its other angles are small
  // enough to be averaged one by one.
  Prior::Prediction between{Pose::from_vector((1.0 - share) * before.vector() + share * after.vector()), a};
  const double turn = wrap_angle(after[Angle::root_torsion] - before[Angle::root_torsion]);
  between.pose[Angle::root_torsion] = wrap_angle(before[Angle::root_torsion] + share * turn);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    between.joints.at[j] = (1.0 - share) * a.at[j] + share * b.at[j];
  }
  return {between, heading};
}

double Objective::operator()(const Pose& pose, const ObjectiveWeights& weights) {
  const Kinematics k = forward_kinematics(model_.body, pose);
  double cost = weights.invalid * (interpenetration(model_.body, k) + 0.5 * outside_limits(limits_, pose));
  if (weights.natural > 0.0) {
    cost += weights.natural * natural_cost(model_.body, pose, k, prior_.heading, arm_prior_of(frame_));
  }
  if (weights.fronto_parallel > 0.0) {
    cost += weights.fronto_parallel * depth_of_arms(k);
  }
  if (prior_.predicted) {
    const auto& [predicted, joints] = *prior_.predicted;
    cost += weights.temporal > 0.0 ? weights.temporal * distance_from_predicted(k, joints) : 0.0;
    cost += weights.trunk > 0.0 ? weights.trunk * trunk_change(pose, predicted) : 0.0;
  }
  Reduction needs = Reduction::none;
  for (std::size_t i = 0; i < cues().size(); ++i) {
    const bool counts = weights.cues[i] > 0.0 && reliability_of(cues()[i], frame_) > 0.0;
    needs = counts ? needs | cues()[i].needs : needs;
  }
  return add_cue_costs(cost, backend_, frame_, weights.cues, scored(pose, needs, {&k, 1}));
}

Score Objective::score(const Pose& pose, Reduction terms) {
  return scored(pose, terms, {});
}

Score Objective::scored(const Pose& pose, Reduction terms, std::span<const Kinematics> kinematics) {
  ++evaluations_;
  Score score;
  backend_.evaluate(frame_, model_, {&pose, 1}, terms, {&score, 1}, kinematics);
  return score;
}

}  // namespace telemime
