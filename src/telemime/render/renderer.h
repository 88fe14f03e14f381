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

/// The projected model, as row-major planes of the camera's size. Outside [left, right) x [top, bottom) they
/// are 0. Keep one per thread and reuse it: it allocates only when the image or the mesh grows.
struct Rendering {
  int width = 0;
  int height = 0;
  int left = 0, top = 0, right = 0, bottom = 0;
  std::vector<std::uint8_t> surface;  ///< SurfaceClass, 0: none; a few bytes longer than the image
  std::vector<float> inverse_depth;   ///< 1/m, 0: none; also a few numbers longer

  /// Working memory: projected vertices (u, v, 1/z), and by triangle 1 (faces the camera), -1 or 0 (too
  /// near).
  std::vector<Eigen::Vector3f> projected;
  std::vector<std::int8_t> facing;
};

/// Renders the class planes with a z-buffer (thesis 2.4.4.2): a pixel belongs to the nearest surface that
/// covers its centre. Surfaces nearer than 5 cm to the camera's plane are dropped.
void render(const BodyMesh& mesh, const Kinematics& kinematics, const Camera& camera, Rendering& out);

using SegmentSet = std::bitset<kSegmentCount>;

/// Renders only these segments. The mesh must have its ranges.
void render_segments(SegmentSet which, const BodyMesh& mesh, const Kinematics& kinematics,
                     const Camera& camera, Rendering& out);

/// Points (px) of the visible occluding contour (thesis 3.5.2), about one per pixel: edges between a
/// front-facing and a back-facing triangle that no other segment hides. `rendering` must be the result of
/// render() with the same mesh. Points outside the image are dropped. `out` is cleared first.
void occluding_contour(const BodyMesh& mesh, const Rendering& rendering, std::vector<Eigen::Vector2f>& out);

}  // namespace telemime
