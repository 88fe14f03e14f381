// SPDX-License-Identifier: Apache-2.0
#include "avatars/tailor.h"

#include <algorithm>
#include <cmath>

namespace telemime {

using Eigen::Vector3d;

Field Tailor::above(double y) const {
  return half_space({0.0, y, 0.0}, -Vector3d::UnitY());
}

Field Tailor::below(double y) const {
  return half_space({0.0, y, 0.0}, Vector3d::UnitY());
}

Field Tailor::within(double x) {
  return [x](const Vector3d& p) { return std::abs(p.x()) - x; };
}

Field Tailor::beyond(double x) {
  return [x](const Vector3d& p) { return x - std::abs(p.x()); };
}

double Tailor::sleeve_end(double length) const {
  const double shoulder = figure.at(HumanBone::l_upper_arm).x();
  const double elbow = figure.at(HumanBone::l_lower_arm).x();
  const double wrist = figure.at(HumanBone::l_hand).x();
  return length <= 1.0 ? std::lerp(shoulder, elbow, length) : std::lerp(elbow, wrist, length - 1.0);
}

Field Tailor::upper_body(double armpit) const {
  return blended({blended({figure.torso, figure.legs}, m(0.040)), figure.arms}, armpit);
}

Field Tailor::lower_body() const {
  return blended({figure.torso, figure.legs}, m(0.045));
}

Eigen::AlignedBox3d Tailor::box(const Vector3d& middle, double x, double y, double z) const {
  const Vector3d half = figure.scale * Vector3d(x, y, z);
  return {middle - half, middle + half};
}

Eigen::AlignedBox3d Tailor::hand_box() const {
  const Vector3d& wrist = figure.at(HumanBone::l_hand);
  return {wrist - figure.scale * Vector3d(0.05, 0.07, 0.09),
          wrist + figure.scale * Vector3d(0.25, 0.07, 0.12)};
}

Eigen::AlignedBox3d Tailor::upper_box() const {
  const double x = figure.at(HumanBone::l_hand).x() + m(0.05);
  return {Vector3d(-x, figure.at(HumanBone::hips).y() - m(0.20), -m(0.20)),
          Vector3d(x, figure.at(HumanBone::neck).y() + m(0.16), m(0.24))};
}

Eigen::AlignedBox3d Tailor::lower_box() const {
  return {Vector3d(-m(0.30), -m(0.02), -m(0.20)),
          Vector3d(m(0.30), figure.at(HumanBone::hips).y() + m(0.20), m(0.22))};
}

Eigen::AlignedBox3d Tailor::arm_box() const {
  const Vector3d& shoulder = figure.at(HumanBone::l_upper_arm);
  return {
      Vector3d(shoulder.x() - m(0.06), shoulder.y() - m(0.12), shoulder.z() - m(0.12)),
      Vector3d(figure.at(HumanBone::l_hand).x() + m(0.25), shoulder.y() + m(0.12), shoulder.z() + m(0.15))};
}

Eigen::AlignedBox3d Tailor::foot_box() const {
  const Vector3d& ankle = figure.at(HumanBone::l_foot);
  return {Vector3d(ankle.x() - m(0.09), -m(0.02), ankle.z() - m(0.12)),
          Vector3d(ankle.x() + m(0.09), m(0.19), ankle.z() + m(0.24))};
}

Eigen::AlignedBox3d Tailor::head_box() const {
  const Vector3d& head = figure.at(HumanBone::head);
  const double s = figure.head_size();
  return {Vector3d(-0.17 * s, figure.at(HumanBone::neck).y() - m(0.16), head.z() - 0.22 * s),
          Vector3d(0.17 * s, head.y() + 0.27 * s, head.z() + 0.17 * s)};
}

void Tailor::add(const std::string& name, Colour colour, double roughness, Triangles surface) {
  const auto same =
      std::find_if(parts.begin(), parts.end(), [&](const AvatarPart& p) { return p.name == name; });
  if (same != parts.end()) {
    append(same->surface, surface);
  } else {
    parts.push_back({name, colour, roughness, std::move(surface)});
  }
}

// The grid resolves the smallest parts of a surface; most of it is flatter.
Triangles Tailor::cut_out(const Field& field, const Eigen::AlignedBox3d& where, double cell) const {
  Triangles surface = surface_of(field, where, m(cell));
  simplify(figure, look.coarse * m(cell), surface);
  return surface;
}

void Tailor::add(const std::string& name, Colour colour, double roughness, const Field& field,
                 const Eigen::AlignedBox3d& box, double cell) {
  add(name, colour, roughness, cut_out(field, box, cell));
}

void Tailor::add_pair(const std::string& name, Colour colour, double roughness, const Field& field,
                      const Eigen::AlignedBox3d& box, double cell) {
  Triangles left = cut_out(field, box, cell);
  Triangles right = mirrored_x(left);
  append(left, right);
  add(name, colour, roughness, std::move(left));
}

}  // namespace telemime
