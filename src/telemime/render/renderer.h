// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <bitset>
#include <cstdint>
#include <vector>

#include "telemime/body/body.h"
#include "telemime/body/mesh.h"
#include "telemime/core/camera.h"

namespace telemime {

/// The projected model: what the camera would see of it. Row-major planes of the camera's size. Only
/// [left, right) x [top, bottom) holds something; outside, `surface` is 0. Keep one per thread and render
/// into it again and again: it allocates only when the image or the mesh grows.
struct Rendering {
  int width = 0;
  int height = 0;
  int left = 0, top = 0, right = 0, bottom = 0;
  std::vector<std::uint8_t> surface;  ///< SurfaceClass, 0: nothing; a few bytes longer than the image
  std::vector<float> inverse_depth;   ///< 1/m; 0: nothing; the same

  /// Working space: projected vertices (u, v, 1/z), facing of triangles.
  std::vector<Eigen::Vector3f> projected;
  std::vector<std::int8_t> facing;
};

/// Renders the class planes with a z-buffer (thesis 2.4.4.2): a pixel belongs to the nearest surface that
/// covers its centre. Surfaces nearer than 5 cm to the camera's plane are left out.
void render(const BodyMesh& mesh, const Kinematics& kinematics, const Camera& camera, Rendering& out);

using SegmentSet = std::bitset<kSegmentCount>;

/// The same with these segments alone; the mesh must have its ranges.
void render_segments(SegmentSet which, const BodyMesh& mesh, const Kinematics& kinematics,
                     const Camera& camera, Rendering& out);

/// Points of the visible occluding contour (thesis 3.5.2), about one a pixel, in pixels: edges that join a
/// front-facing to a back-facing triangle and are not hidden by another segment. Call after render() with the
/// same arguments. Points outside the image are left out. `out` is cleared first.
void occluding_contour(const BodyMesh& mesh, const Rendering& rendering, std::vector<Eigen::Vector2f>& out);

}  // namespace telemime
