// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "avatars/surface.h"
#include "telemime/body/body.h"
#include "telemime/outputs/humanoid.h"

namespace telemime {

/// The undressed person as solids in the T-pose world (humanoid.h), the same on both sides. Girths follow the
/// segments of body/mesh.h with softer transitions; lengths are the body's.
struct Figure {
  HumanoidSkeleton skeleton;
  double scale = 1.0;  ///< stature over 1.70 m
  SegmentScale head_shape;
  Field torso;  ///< from the seat to the base of the neck, with the shoulders
  Field arms;   ///< to the wrists
  Field hands;
  Field neck;
  Field skull;  ///< head without nose and ears
  Field head;   ///< with them, without hair
  Field legs;
  Field feet;  ///< as big as a shoe

  const Eigen::Vector3d& at(HumanBone bone) const {
    return skeleton.position[static_cast<std::size_t>(bone)];
  }
  /// The point (x, y, z) from the head's joint, m of a head of the default size.
  Eigen::Vector3d in_head(double x, double y, double z) const;
  double head_size() const;  ///< over the default one
};

/// `body` must be the same on both sides.
Figure make_figure(const Body& body);

}  // namespace telemime
