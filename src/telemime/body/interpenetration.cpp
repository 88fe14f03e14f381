// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/interpenetration.h"

#include <algorithm>
#include <array>

#include "telemime/body/arm_parts.h"

namespace telemime {
namespace {

constexpr double kCapsuleStature = 1.70;  // m: the other lengths are those of a person of this stature
// Two upright capsules fill the broad chest better than one: from the waist to the collar, a little ahead of
// the spine. Of a deep and narrow chest they must not reach the hanging arms.
constexpr double kChestAside = 0.060;   // m
constexpr double kChestLow = -0.05;     // m
constexpr double kChestHigh = 0.42;     // m
constexpr double kAheadLow = 0.05;      // m
constexpr double kAheadHigh = 0.03;     // m
constexpr double kChestRadius = 0.080;  // m
// One capsule fills the head between these shares of the way from its joint to its top.
constexpr double kHeadLow = 0.2;
constexpr double kHeadHigh = 0.6;
constexpr double kHeadRadius = 0.060;  // m
// The upper arm counts from its middle on: above, it is at the chest in every pose. Arms are thinner than
// they are, so that touching is free.
constexpr double kUpperFrom = 0.5;
constexpr double kUpperRadius = 0.030;  // m
constexpr double kForeRadius = 0.025;   // m
constexpr double kHandRadius = 0.015;   // m
constexpr double kPoint = 1e-12;        // m^2: a segment that short is a point

struct Capsule {
  Eigen::Vector3d a, b;
  double radius;
};

// Distance between two segments of lines (Ericson, Real-Time Collision Detection, 2005, 5.1.9).
double distance(const Capsule& p, const Capsule& q) {
  const Eigen::Vector3d d1 = p.b - p.a;
  const Eigen::Vector3d d2 = q.b - q.a;
  const Eigen::Vector3d r = p.a - q.a;
  const double a = d1.squaredNorm();
  const double e = d2.squaredNorm();
  const double f = d2.dot(r);
  const double c = d1.dot(r);
  const double b = d1.dot(d2);
  const double denominator = a * e - b * b;
  double s = denominator > kPoint ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double t = e > kPoint ? (b * s + f) / e : 0.0;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = a > kPoint ? std::clamp((b * t - c) / a, 0.0, 1.0) : 0.0;
  }
  return (r + d1 * s - d2 * t).norm();
}

}  // namespace

double interpenetration(const Body& body, const Kinematics& k) {
  const double size = body.shape.stature / kCapsuleStature;
  const SegmentScale& chest = body.shape[Segment::chest];
  const auto inside = [&](double x, double y, double z) -> Eigen::Vector3d {
    return k[Segment::chest] *
           Eigen::Vector3d(x * size * chest.width, y * size * chest.length, z * size * chest.height);
  };
  const double thick = kChestRadius * size * std::min(chest.height, chest.width);
  const std::array<Capsule, 3> trunk = {{
      {inside(kChestAside, kChestLow, kAheadLow), inside(kChestAside, kChestHigh, kAheadHigh), thick},
      {inside(-kChestAside, kChestLow, kAheadLow), inside(-kChestAside, kChestHigh, kAheadHigh), thick},
      {k.joints[Joint::head] + kHeadLow * (k.joints[Joint::head_top] - k.joints[Joint::head]),
       k.joints[Joint::head] + kHeadHigh * (k.joints[Joint::head_top] - k.joints[Joint::head]),
       kHeadRadius * size},
  }};
  struct Arm {
    Capsule upper, fore, hand;
  };
  std::array<Arm, 2> arms;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const ArmParts& parts = kArmParts[i];
    const Eigen::Vector3d& shoulder = k.joints[parts.shoulder];
    const Eigen::Vector3d& elbow = k.joints[parts.elbow];
    const Eigen::Vector3d& wrist = k.joints[parts.wrist];
    const Eigen::Vector3d& hand = k.joints[parts.knuckle];
    arms[i] = {{shoulder + kUpperFrom * (elbow - shoulder), elbow, kUpperRadius * size},
               {elbow, wrist, kForeRadius * size},
               {wrist, hand, kHandRadius * size}};
  }
  double total = 0.0;
  const auto add = [&](const Capsule& p, const Capsule& q) {
    total += std::max(0.0, p.radius + q.radius - distance(p, q));
  };
  for (const Arm& arm : arms) {
    for (const Capsule& part : trunk) {
      add(arm.upper, part);
      add(arm.fore, part);
      add(arm.hand, part);
    }
  }
  for (const Capsule* p : {&arms[0].fore, &arms[0].hand}) {
    for (const Capsule* q : {&arms[1].fore, &arms[1].hand}) {
      add(*p, *q);
    }
  }
  return total;
}

}  // namespace telemime
