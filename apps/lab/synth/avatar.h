// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lab/synth/actor.h"
#include "lab/synth/hand.h"
#include "lab/synth/head.h"
#include "lab/synth/look.h"
#include "lab/synth/sdf.h"

namespace telemime {

/// What a pixel shows.
enum class Surface : std::uint8_t { background, head, arm, shirt, hair, trousers };

/// Cuts a part off where (p - at) . normal > 0, camera frame; used for hems.
struct Hem {
  Eigen::Vector3f at{0.0f, 0.0f, 0.0f};
  Eigen::Vector3f normal{0.0f, 0.0f, 0.0f};  ///< zero: no cut
};

/// One piece of the body with the ball that bounds it.
struct BodyPart {
  enum class Kind : std::uint8_t { limb, torso, head, hair, hand };
  Kind kind = Kind::limb;
  Surface surface = Surface::arm;
  std::uint8_t chain = 0;  ///< parts of one chain flow into each other, parts of different chains do not
  float blend = 0.02f;     ///< m, how softly
  Eigen::Vector3f centre{0.0f, 0.0f, 0.0f};  ///< of the bounding ball, camera frame, m
  float radius = 0.0f;
  /// Camera frame to the part's own: local = rotation (p - origin) / scale. Limbs: y along the bone.
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
  Eigen::Vector3f origin{0.0f, 0.0f, 0.0f};
  float scale = 1.0f;
  std::vector<RoundCone> cones;  ///< limb: camera frame; torso: shoulders and chest in its own frame
  Hem hem;
  HandShape hand;
};

/// The person of one frame: a body of smoothly joined solids, made for this program and unlike the tracker's.
/// Parts of a chain follow each other.
struct Avatar {
  Look look;
  AvatarHead head;
  float girth = 1.0f;
  std::vector<BodyPart> parts;
};

/// Builds the body around the bones.
Avatar make_avatar(const Look& look, const ActorKinematics& kinematics);

/// The parts that a ray or a point can meet; a cheap subset for many distance queries.
struct PartSelection {
  static constexpr std::size_t kMost = 24;
  std::array<const BodyPart*, kMost> parts{};
  std::size_t count = 0;
  float near = 0.0f;  ///< along the ray: nothing of the parts lies before ...
  float far = 0.0f;   ///< ... or behind these, m
};

/// Parts whose bounding ball, grown by `margin` (m), meets the ray; `direction` of length 1.
PartSelection parts_along(const Avatar& avatar, const Eigen::Vector3f& origin,
                          const Eigen::Vector3f& direction, float margin);

/// Parts whose bounding ball lies within `margin` (m) of the point.
PartSelection parts_near(const Avatar& avatar, const Eigen::Vector3f& point, float margin);

struct BodySample {
  float distance = 1e9f;  ///< m; a lower bound away from the surface
  const BodyPart* part = nullptr;
};

/// Distance from p (camera frame) to the nearest surface of the selected parts, and the part it belongs to.
BodySample sample_body(const Avatar& avatar, const PartSelection& selection, const Eigen::Vector3f& p);

/// Colour of the surface, linear light.
Eigen::Vector3f surface_colour(const Avatar& avatar, const BodyPart& part, const Eigen::Vector3f& p);

}  // namespace telemime
