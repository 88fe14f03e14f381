// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "avatars/field.h"

namespace telemime {

/// A triangle mesh, m; triangles are counter-clockwise seen from outside.
struct Triangles {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3d> normals;  ///< unit length, one a vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Appends `more` to `surface`.
void append(Triangles& surface, const Triangles& more);

/// The mirror image in the plane x = 0.
Triangles mirrored_x(Triangles surface);

/// Where the field is 0 inside the box, by surface nets (Gibson, MICCAI 1998) on a grid of this `cell` (m),
/// with every vertex moved onto the surface and the field's direction as its normal. The solid must not touch
/// the box. A field that is not a true distance must not be more than twice it.
Triangles surface_of(const Field& field, const Eigen::AlignedBox3d& box, double cell);

}  // namespace telemime
