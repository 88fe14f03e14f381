// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace telemime {

/// A solid as a field over space (m): negative inside, positive outside, near its surface about the distance
/// to it. Shapes flow into each other where fields are blended, which is why skin has no seams.
using Field = std::function<double(const Eigen::Vector3d&)>;

Field ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii);

/// A ball that rolls from `a` to `b` and changes its radius on the way.
Field round_cone(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius_a, double radius_b);

/// A box with rounded edges; `half` are half its sides, with the rounding.
Field round_box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half, double rounding);

/// Behind a plane: `normal` (unit length) points out.
Field half_space(const Eigen::Vector3d& point, const Eigen::Vector3d& normal);

/// An ellipse across an axis: m from the loft's origin.
struct LoftRing {
  double at = 0.0;      ///< along the axis, ascending
  double centre = 0.0;  ///< of the ellipse, along `front`
  double radius_side = 0.0;
  double radius_front = 0.0;
};

/// Ellipses joined by a smooth surface, flat at both ends. `along` and `front` are perpendicular unit
/// vectors; at least two rings.
Field loft(const Eigen::Vector3d& origin, const Eigen::Vector3d& along, const Eigen::Vector3d& front,
           std::vector<LoftRing> rings);

/// All of them, their meeting edges filled over a width of about `blend`. Not empty.
Field blended(std::vector<Field> fields, double blend);

/// What is in both, with the edge rounded by about `rounding`.
Field overlap(Field a, Field b, double rounding);

/// `a` without `b`, likewise.
Field without(Field a, Field b, double rounding);

/// A tube along the curve where two surfaces meet.
Field seam(Field a, Field b, double radius);

/// Grown by `distance`; negative: shrunk.
Field grown(Field a, double distance);

/// The half at x >= 0 and its mirror image.
Field mirror_x(Field a);

/// Unit vector in which the field grows.
Eigen::Vector3d outward(const Field& field, const Eigen::Vector3d& point, double step);

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

struct Figure;

/// Fewer triangles, whose vertices are some of those that there were: edges are collapsed (Garland and
/// Heckbert, SIGGRAPH 1997, by meshoptimizer) as long as the surface stays within about `error` (m). That is
/// measured on the figure with every joint bent, so that what has to bend keeps vertices for it.
void simplify(const Figure& figure, double error, Triangles& surface);

}  // namespace telemime
