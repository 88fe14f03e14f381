// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/interpenetration.h"

#include <algorithm>
#include <array>

namespace telemime {
namespace {

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
  double s = denominator > 1e-12 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double t = e > 1e-12 ? (b * s + f) / e : 0.0;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = a > 1e-12 ? std::clamp((b * t - c) / a, 0.0, 1.0) : 0.0;
  }
  return (r + d1 * s - d2 * t).norm();
}

}  // namespace

double interpenetration(const Body& body, const Kinematics& k) {
  const double size = body.shape.stature / 1.70;
  const SegmentScale& chest = body.shape[Segment::chest];
  const auto inside = [&](double x, double y, double z) -> Eigen::Vector3d {
    return k[Segment::chest] *
           Eigen::Vector3d(x * size * chest.width, y * size * chest.length, z * size * chest.height);
  };
  // Two upright capsules fill the broad chest better than one.
  // Of a deep and narrow chest they must not reach the hanging arms.
  const double thick = 0.080 * size * std::min(chest.height, chest.width);
  const std::array<Capsule, 3> trunk = {{
      {inside(0.060, -0.05, 0.05), inside(0.060, 0.42, 0.03), thick},
      {inside(-0.060, -0.05, 0.05), inside(-0.060, 0.42, 0.03), thick},
      {k.joints[Joint::head] + 0.2 * (k.joints[Joint::head_top] - k.joints[Joint::head]),
       k.joints[Joint::head] + 0.6 * (k.joints[Joint::head_top] - k.joints[Joint::head]), 0.060 * size},
  }};
  struct Arm {
    Capsule upper, fore, hand;
  };
  std::array<Arm, 2> arms;
  for (const bool left : {true, false}) {
    const Eigen::Vector3d& shoulder = k.joints[left ? Joint::l_shoulder : Joint::r_shoulder];
    const Eigen::Vector3d& elbow = k.joints[left ? Joint::l_elbow : Joint::r_elbow];
    const Eigen::Vector3d& wrist = k.joints[left ? Joint::l_wrist : Joint::r_wrist];
    const Eigen::Vector3d& hand = k.joints[left ? Joint::l_hand : Joint::r_hand];
    arms[left ? 0 : 1] = {{shoulder + 0.5 * (elbow - shoulder), elbow, 0.030 * size},
                          {elbow, wrist, 0.025 * size},
                          {wrist, hand, 0.015 * size}};
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
