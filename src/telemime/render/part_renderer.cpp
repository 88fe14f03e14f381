// SPDX-License-Identifier: Apache-2.0
#include "telemime/render/part_renderer.h"

#include <algorithm>

namespace telemime {
namespace {

// As many as an arm has: with more, a base would save little.
constexpr std::size_t kMostMoved = 3;

// Segments that are not exactly where they were.
SegmentSet moved(const Kinematics& from, const Kinematics& to) {
  SegmentSet set;
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    set[s] = from.camera_from_segment[s].matrix() != to.camera_from_segment[s].matrix();
  }
  return set;
}

bool same(const Camera& a, const Camera& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy && a.cx == b.cx &&
         a.cy == b.cy;
}

}  // namespace

bool PartRenderer::remembered(const BodyMesh& mesh, const Camera& camera) const {
  return same(camera, camera_) && mesh.vertices == vertices_ &&
         std::equal(mesh.triangles.begin(), mesh.triangles.end(), surfaces_.begin(), surfaces_.end(),
                    [](const MeshTriangle& t, SurfaceClass s) { return t.surface == s; });
}

void PartRenderer::remember(const BodyMesh& mesh, const Camera& camera) {
  camera_ = camera;
  vertices_ = mesh.vertices;
  surfaces_.clear();
  for (const MeshTriangle& t : mesh.triangles) {
    surfaces_.push_back(t.surface);
  }
  in_base_.reset();
  last_.reset();
}

const Rendering& PartRenderer::render(const BodyMesh& mesh, const Kinematics& kinematics,
                                      const Camera& camera) {
  if (!remembered(mesh, camera)) {
    remember(mesh, camera);
  }
  const bool based = in_base_.any() && (moved(base_kinematics_, kinematics) & in_base_).none();
  if (!based && last_) {
    const SegmentSet free = moved(*last_, kinematics);
    if (free.any() && free.count() <= kMostMoved) {
      in_base_ = ~free;
      base_kinematics_ = kinematics;
      render_segments(in_base_, mesh, kinematics, camera, base_);
    } else {
      in_base_.reset();
    }
  }
  last_ = kinematics;
  if (in_base_.any()) {
    render_over(base_, ~in_base_, mesh, kinematics, camera, rendering_);
  } else {
    telemime::render(mesh, kinematics, camera, rendering_);
  }
  return rendering_;
}

}  // namespace telemime
