// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "avatars/avatar.h"
#include "avatars/figure.h"
#include "avatars/surface.h"

namespace telemime {

/// The expressions of VRM 1.0 that an avatar's face has, each as one morph target.
enum class FaceShape : std::size_t {
  blink_left,
  blink_right,
  aa,
  ih,
  ou,
  ee,
  oh,
  happy,
  angry,
  sad,
  relaxed,
  surprised,
  look_up,
  look_down,
  look_left,
  look_right,
};
inline constexpr std::size_t kFaceShapeCount = 16;
inline constexpr std::array<std::string_view, kFaceShapeCount> kFaceShapeNames = {
    "blinkLeft", "blinkRight", "aa",      "ih",        "ou",     "ee",       "oh",       "happy",
    "angry",     "sad",        "relaxed", "surprised", "lookUp", "lookDown", "lookLeft", "lookRight"};

/// A surface of one colour, in the T-pose.
struct AvatarPart {
  std::string name;  ///< of its material; parts of the same name are of the same material
  Colour colour = 0;
  double roughness = 0.8;  ///< 0 mirror, 1 chalk
  Triangles surface;
  bool glows = false;
  /// Displacement of each vertex for each FaceShape; empty for parts that do not move.
  std::array<std::vector<Eigen::Vector3d>, kFaceShapeCount> moved = {};
};

/// What garments are cut with: planes of the T-pose world and boxes about the person.
struct Tailor {
  const Figure& figure;
  const AvatarLook& look;
  std::vector<AvatarPart> parts;

  double m(double metres) const { return figure.scale * metres; }  ///< of a person of 1.70 m
  Field above(double y) const;
  Field below(double y) const;
  /// Nearer to the middle than x, on both sides; and farther.
  static Field within(double x);
  static Field beyond(double x);
  /// Where a sleeve of this length ends: 0 shoulder, 1 elbow, 2 wrist.
  double sleeve_end(double length) const;
  /// Trunk, arms and thighs in one.
  Field upper_body(double armpit) const;
  /// Seat and legs in one.
  Field lower_body() const;

  /// A box about a point, given by half its sides at 1.70 m.
  Eigen::AlignedBox3d box(const Eigen::Vector3d& middle, double x, double y, double z) const;
  Eigen::AlignedBox3d upper_box() const;
  Eigen::AlignedBox3d lower_box() const;
  Eigen::AlignedBox3d arm_box() const;   ///< the left one, from the shoulder
  Eigen::AlignedBox3d foot_box() const;  ///< the left one
  Eigen::AlignedBox3d hand_box() const;  ///< the left one
  Eigen::AlignedBox3d head_box() const;

  Triangles cut_out(const Field& field, const Eigen::AlignedBox3d& where, double cell) const;
  void add(const std::string& name, Colour colour, double roughness, Triangles surface);
  void add(const std::string& name, Colour colour, double roughness, const Field& field,
           const Eigen::AlignedBox3d& box, double cell);
  /// The left one and its mirror image.
  void add_pair(const std::string& name, Colour colour, double roughness, const Field& field,
                const Eigen::AlignedBox3d& box, double cell);
};

/// Skin and clothes, without hair and face.
std::vector<AvatarPart> make_outfit(const Figure& figure, const AvatarLook& look);

/// What is fixed to the head: hair, or a robot's helmet; may be empty.
std::vector<AvatarPart> make_hair(const Figure& figure, const AvatarLook& look);

/// Eyes, brows and mouth, drawn on the head. All parts know all shapes.
std::vector<AvatarPart> make_face(const Figure& figure, const AvatarLook& look);

/// White shells over a dark frame.
void dress_robot(Tailor& tailor);
/// Its helmet.
void add_robot_head(Tailor& tailor);
/// The glass before its face.
Field robot_visor(const Figure& figure);

}  // namespace telemime
