// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "avatars/tailor.h"

namespace telemime {
namespace {

using Eigen::Vector3d;

constexpr double kShell = 0.35;
constexpr double kFrame = 0.6;
constexpr double kCell = 0.0115;
constexpr double kFine = 0.0072;

Field helmet(const Figure& f) {
  const double s = f.head_size();
  Field box = round_box(f.in_head(0.0, 0.048, 0.004), s * Vector3d(0.096, 0.092, 0.092), 0.060 * s);
  Field ears =
      mirror_x(round_cone(f.in_head(0.086, 0.040, 0.0), f.in_head(0.104, 0.040, 0.0), 0.030 * s, 0.024 * s));
  return blended({std::move(box), std::move(ears)}, 0.008 * s);
}

Field opening(const Figure& f) {
  return round_box(f.in_head(0.0, 0.032, 0.100), f.head_size() * Vector3d(0.074, 0.052, 0.060),
                   0.040 * f.head_size());
}

/// A shell over a piece of an arm or a leg, between two places along it.
Field sleeve(const Tailor& t, const Field& limb, double thickness, const Field& from, const Field& to) {
  return overlap(grown(limb, t.m(thickness)), overlap(from, to, t.m(0.006)), t.m(0.014));
}

}  // namespace

Field robot_visor(const Figure& figure) {
  const double s = figure.head_size();
  return round_box(figure.in_head(0.0, 0.046, 0.002), s * Vector3d(0.091, 0.087, 0.089), 0.058 * s);
}

void add_robot_head(Tailor& t) {
  const double s = t.figure.head_size();
  t.add("shell", t.look.top, kShell, without(helmet(t.figure), opening(t.figure), 0.008 * s), t.head_box(),
        kFine);
  t.add("visor", 0x10151B, 0.12, robot_visor(t.figure), t.head_box(), kCell);
  const Field mast = round_cone(t.figure.in_head(0.0, 0.135, 0.0), t.figure.in_head(0.0, 0.172, -0.004),
                                0.0055 * s, 0.004 * s);
  t.add("frame", t.look.skin, kFrame, mast, t.head_box(), 0.0035);
  t.add("trim", t.look.trim, kShell,
        ellipsoid(t.figure.in_head(0.0, 0.180, -0.004), s * Vector3d(0.012, 0.012, 0.012)), t.head_box(),
        0.0035);
}

void dress_robot(Tailor& t) {
  const Figure& f = t.figure;
  const auto y = [&](HumanBone bone) { return f.at(bone).y(); };
  using enum HumanBone;
  const Field upper = blended({f.torso, f.arms}, t.m(0.05));
  const Field lower = t.lower_body();
  const double wrist = f.at(l_hand).x();
  // The frame is seen at the joints, the neck and the hands.
  Field trunk = blended({upper, lower}, t.m(0.01));
  t.add("frame", t.look.skin, kFrame,
        overlap(grown(blended({std::move(trunk), f.neck}, t.m(0.02)), -t.m(0.004)), Tailor::within(wrist),
                t.m(0.004)),
        Eigen::AlignedBox3d(t.lower_box()).extend(t.upper_box()), 0.0140);
  t.add_pair("frame", t.look.skin, kFrame,
             overlap(blended({f.arms, f.hands}, t.m(0.012)), Tailor::beyond(wrist - t.m(0.03)), t.m(0.006)),
             t.hand_box(), 0.0050);

  const double shoulder = f.at(l_upper_arm).x();
  const double elbow = f.at(l_lower_arm).x();
  const Field collar =
      ellipsoid(f.at(neck) + f.scale * Vector3d(0.0, 0.045, 0.010), f.scale * Vector3d(0.078, 0.075, 0.078));
  const auto shell = [&](const Field& field, const Eigen::AlignedBox3d& box) {
    t.add("shell", t.look.top, kShell, field, box, kCell);
  };
  shell(overlap(without(sleeve(t, upper, 0.012, t.above(y(spine) + t.m(0.10)), t.below(y(neck) + t.m(0.05))),
                        collar, t.m(0.008)),
                Tailor::within(shoulder - t.m(0.028)), t.m(0.020)),
        t.upper_box());
  shell(sleeve(t, lower, 0.011, t.above(y(l_upper_leg) - t.m(0.075)), t.below(y(spine) + t.m(0.015))),
        t.lower_box());
  Field cap = mirror_x(ellipsoid(f.at(l_upper_arm) + f.scale * Vector3d(0.022, 0.006, 0.0),
                                 f.scale * Vector3d(0.062, 0.071, 0.073)));
  shell(overlap(std::move(cap), Tailor::beyond(shoulder - t.m(0.020)), t.m(0.012)), t.upper_box());
  shell(sleeve(t, f.arms, 0.008, Tailor::beyond(shoulder + t.m(0.088)), Tailor::within(elbow - t.m(0.040))),
        t.upper_box());
  shell(sleeve(t, f.arms, 0.009, Tailor::beyond(elbow + t.m(0.040)), Tailor::within(wrist - t.m(0.020))),
        t.upper_box());
  const double knee = y(l_lower_leg);
  shell(sleeve(t, f.legs, 0.010, t.above(knee + t.m(0.055)), t.below(y(l_upper_leg) - t.m(0.100))),
        t.lower_box());
  shell(sleeve(t, f.legs, 0.011, t.above(y(l_foot) + t.m(0.030)), t.below(knee - t.m(0.055))), t.lower_box());
  t.add_pair("shell", t.look.top, kShell, f.feet, t.foot_box(), kFine);
  t.add_pair(
      "soles", t.look.shoes, kFrame,
      overlap(grown(f.feet, t.m(0.004)), overlap(t.below(t.m(0.018)), t.above(0.0), t.m(0.003)), t.m(0.006)),
      t.foot_box(), kFine);
  t.add("trim", t.look.trim, kShell, seam(grown(upper, t.m(0.0115)), collar, t.m(0.0055)),
        t.box(f.at(neck), 0.14, 0.12, 0.14), 0.0040);
  // Rings at the elbows and wrists, a light on the chest.
  for (const double x : {elbow - t.m(0.046), elbow + t.m(0.046), wrist - t.m(0.026)}) {
    t.add_pair("trim", t.look.trim, kShell, seam(grown(f.arms, t.m(0.0075)), Tailor::within(x), t.m(0.0055)),
               t.box({x, f.at(l_hand).y(), f.at(l_hand).z()}, 0.03, 0.075, 0.075), 0.0038);
  }
  const Vector3d lamp = f.at(chest) + f.scale * Vector3d(0.0, 0.075, 0.0);
  Field disc =
      overlap(grown(upper, t.m(0.0160)),
              round_cone(lamp, lamp + f.scale * Vector3d(0.0, 0.0, 0.3), t.m(0.026), t.m(0.026)), t.m(0.005));
  t.add("trim", t.look.trim, kShell,
        overlap(std::move(disc), half_space(lamp + f.scale * Vector3d(0.0, 0.0, 0.09), -Vector3d::UnitZ()),
                t.m(0.003)),
        t.box(lamp + f.scale * Vector3d(0.0, 0.0, 0.15), 0.05, 0.05, 0.10), 0.0055);
}

}  // namespace telemime
