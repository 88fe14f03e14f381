// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/hands.h"

#include <algorithm>
#include <cmath>

#include "telemime/body/arm_parts.h"
#include "telemime/body/hand_fit.h"
#include "telemime/body/rotations.h"
#include "telemime/core/time_base.h"

namespace telemime {
namespace {

constexpr double kFarthest = 0.2;  // m, of a hand's wrist from that of its arm
constexpr double kNearest = 0.05;  // m, of a wrist from the camera
constexpr double kHeld = 0.1;      // s, that a hand keeps its form when it is not seen
constexpr double kTurn = 0.6;      // s, that it keeps it while the other hand has its turn
constexpr double kWorst = 0.03;    // m, of the points from the model: what fits worse is not a hand

// m between a finding and an arm's wrist, across the line of sight; more if it looks like the other hand.
double distance_to_arm(const HandLandmarks& hand, Side side, const HandScene& scene) {
  constexpr double kOtherHand = 0.05;
  Eigen::Vector3d wrist = scene.kinematics.joints[arm_parts(side).wrist];
  wrist.z() = std::max(wrist.z(), kNearest);
  const double pixels = (scene.camera.project(wrist) - hand.points[0].pixel).norm();
  return pixels * wrist.z() / scene.camera.fx +
         kOtherHand * (side == Side::right ? 1.0 - hand.is_right : hand.is_right);
}

// The palm is the mean of all frames, the average hand counting as some of them; after enough frames it
// stays.
void learn_palm(const HandScene& scene, double seen, HandState& state) {
  constexpr double kAverage = 25.0;  // frames
  constexpr double kEnough = 250.0;
  constexpr double kMost = 0.25;  // that a palm differs from the average, as a logarithm
  if (state.frames >= kEnough) {
    return;
  }
  state.frames += 1.0;
  const double average = average_hand(scene.body.shape.stature).palm;
  const double learned = std::log(state.sizes->palm / average);
  const double palm = std::clamp(std::log(seen / average), -kMost, kMost);
  state.sizes->palm = average * std::exp(learned + (palm - learned) / (kAverage + state.frames));
}

// The hand of this arm behind a finding. A network that takes the palm for the back sees the other hand, its
// depths reversed: both are tried, and how well they fit, which hand the network sees, and how the palm was
// turned before decide.
std::optional<HandFit> likelier_hand(const HandLandmarks& hand, Side side, double depth,
                                     const HandScene& scene, const HandState& state) {
  constexpr double kSide = 4.0;  // weight of the network's opinion
  constexpr double kLeastChance = 0.02;
  constexpr double kCertain = 0.9;
  constexpr double kUsualTurn = 1.0;   // rad, of a palm in a frame, or in 1/25 s where frames are rarer
  constexpr double kMostOfTurn = 6.0;  // of the cost
  const double own =
      std::clamp(side == Side::right ? hand.is_right : 1.0 - hand.is_right, kLeastChance, 1.0 - kLeastChance);
  const auto& last = state.last[static_cast<std::size_t>(side)];
  const auto tried = [&](double sign, double chance) {
    HandLandmarks seen = hand;
    for (HandLandmark& p : seen.points) {
      p.world.z() *= sign;
    }
    auto result = likeliest_hand(*state.sizes, metric_points(seen, scene.camera, depth), side);
    if (result) {
      result->cost -= kSide * std::log(chance);
      if (last && last->motion.seen) {
        const double turn = last->motion.seen->angularDistance(Eigen::Quaterniond(result->frame_from_hand));
        const double usual = kUsualTurn * std::max(1.0, units_between(last->time, scene.time));
        result->cost += std::min(kMostOfTurn, (turn / usual) * (turn / usual));
      }
    }
    return result;
  };
  auto as_seen = tried(1.0, own);
  const double off = as_seen ? as_seen->error / kWorst : 1.0;
  if (own > kCertain && off < 1.0 / 3.0) {
    return as_seen;
  }
  const auto reversed = tried(-1.0, 1.0 - own);
  return as_seen && (!reversed || as_seen->cost <= reversed->cost) ? as_seen : reversed;
}

// How much a hand can be believed that looks like this: less, the more its palm would have turned or a finger
// bent faster than hands usually do since it was last seen. Frames that follow each other closely differ
// mostly by noise.
double trust_in_motion(const HandMotion& now, double time, const std::optional<HandState::Last>& last) {
  constexpr double kFastestTurn = 25.0;    // rad/s
  constexpr double kFastestFinger = 15.0;  // rad/s
  if (!last || !last->motion.seen || !(time > last->time)) {
    return 1.0;
  }
  const double step = std::max(kTimeUnit, time - last->time);
  const double turn = last->motion.seen->angularDistance(*now.seen) / (kFastestTurn * step);
  double bend = 0.0;
  for (std::size_t a = 0; a < now.angles.size(); ++a) {
    bend = std::max(bend, std::abs(now.angles[a] - last->motion.angles[a]) / (kFastestFinger * step));
  }
  return 1.0 / std::max({1.0, turn, bend});
}

// The model on a finding; empty if it is not a hand.
std::optional<HandMotion> fitted(const HandLandmarks& hand, Side side, const HandScene& scene,
                                 HandState& state) {
  constexpr double kGood = 0.8;     // presence from which on the palm is learned
  constexpr double kNoise = 0.008;  // m
  const double depth = std::max(kNearest, scene.kinematics.joints[arm_parts(side).wrist].z());
  const auto likely = likelier_hand(hand, side, depth, scene, state);
  const double error = likely ? likely->error : kWorst;
  if (!likely || !(error < kWorst)) {
    return std::nullopt;
  }
  if (hand.presence > kGood) {
    learn_palm(scene, likely->scale * state.sizes->palm, state);
  }
  const double off = error / kWorst;
  HandMotion motion;
  motion.sizes = *state.sizes;
  motion.angles = likely->angles;
  motion.seen = Eigen::Quaterniond(likely->frame_from_hand).normalized();
  const double trust = trust_in_motion(motion, scene.time, state.last[static_cast<std::size_t>(side)]);
  motion.visibility = std::clamp(hand.presence * (1.0 - off * off) * trust, 0.0, 1.0);
  motion.spread = std::hypot(kNoise, error);
  return motion;
}

}  // namespace

std::array<const HandLandmarks*, 2> hands_of_arms(const std::array<SeenHand, 2>& seen,
                                                  const HandScene& scene) {
  // What it costs to give finding f to side s; none costs as much as one that is too far away.
  const auto cost = [&](std::size_t f, std::size_t s) {
    return seen[f].found ? std::min(kFarthest, distance_to_arm(*seen[f].found, static_cast<Side>(s), scene))
                         : kFarthest;
  };
  const bool swapped = cost(0, 1) + cost(1, 0) < cost(0, 0) + cost(1, 1);
  std::array<const HandLandmarks*, 2> result{};
  for (std::size_t s = 0; s < 2; ++s) {
    const std::size_t f = swapped ? 1 - s : s;
    result[s] = cost(f, s) < kFarthest ? &*seen[f].found : nullptr;
  }
  return result;
}

HandPoints metric_points(const HandLandmarks& hand, const Camera& camera, double depth) {
  // The network's points about the wrist, which it sees along the wrist's ray.
  const Eigen::Vector3d wrist = camera.ray(hand.points[0].pixel);
  const Eigen::Matrix3d turn = rotation_between(Eigen::Vector3d::UnitZ(), wrist).toRotationMatrix();
  HandPoints world;
  for (std::size_t i = 0; i < kHandJointCount; ++i) {
    world[i] = turn * (hand.points[i].world - hand.points[0].world);
  }
  const auto extent = [](const HandPoints& points) {
    Eigen::Matrix<double, 2, kHandJointCount> across;
    for (std::size_t i = 0; i < kHandJointCount; ++i) {
      across.col(static_cast<Eigen::Index>(i)) = points[i].head<2>();
    }
    return (across.colwise() - across.rowwise().mean()).norm();
  };
  // On their rays, first all as far away as the wrist; then as much nearer or farther as the network has
  // them, stretched to the size that they have in the picture.
  constexpr double kNearestShare = 0.5;
  const double size = extent(world);
  HandPoints points;
  double stretch = 0.0;
  for (int turns = 0; turns < 3; ++turns) {
    for (std::size_t i = 0; i < kHandJointCount; ++i) {
      const double along = std::max(kNearestShare * depth, depth + stretch * world[i].z());
      points[i] = camera.ray(hand.points[i].pixel) * along - wrist * depth;
    }
    stretch = size > 0.0 ? extent(points) / size : 0.0;
  }
  return points;
}

HandMotions observe_hands(const std::array<SeenHand, 2>& seen, const HandScene& scene, HandState& state) {
  if (!state.sizes) {
    state.sizes = average_hand(scene.body.shape.stature);
  }
  const auto mine = hands_of_arms(seen, scene);
  HandMotions hands;
  for (const Side side : {Side::left, Side::right}) {
    const auto s = static_cast<std::size_t>(side);
    auto& last = state.last[s];
    if (const auto found = mine[s] != nullptr ? fitted(*mine[s], side, scene, state) : std::nullopt) {
      last = HandState::Last{.motion = *found, .time = scene.time};
    }
    const double held = seen[s].looked ? kHeld : kTurn;
    if (last && (scene.time < last->time || scene.time - last->time > held)) {
      last.reset();
    }
    hands[s] = last ? last->motion : HandMotion{};
    hands[s].sizes = *state.sizes;
  }
  place_hands(scene.kinematics, hands);
  return hands;
}

}  // namespace telemime
