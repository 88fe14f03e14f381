// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "avatars/figure.h"
#include "avatars/look.h"
#include "avatars/surface.h"

namespace telemime {

/// A surface of one colour, in the T-pose.
struct AvatarPart {
  std::string name;  ///< of its material; parts of the same name are of the same material
  Colour colour = 0;
  double roughness = 0.8;  ///< 0 mirror, 1 chalk
  Triangles surface;
  bool glows = false;
  std::vector<Eigen::Vector3d> blink = {};  ///< where each vertex goes when the eyes close; else empty
};

/// Skin and clothes, without hair and face.
std::vector<AvatarPart> make_outfit(const Figure& figure, const AvatarLook& look);

/// What is fixed to the head: hair, or a robot's helmet; may be empty.
std::vector<AvatarPart> make_hair(const Figure& figure, const AvatarLook& look);

/// Eyes, brows and mouth, drawn on the head. All parts know how to blink.
std::vector<AvatarPart> make_face(const Figure& figure, const AvatarLook& look);

}  // namespace telemime
