// SPDX-License-Identifier: Apache-2.0
#include "telemime/render/renderer.h"

#include <algorithm>
#include <cmath>

namespace telemime {
namespace {

constexpr float kNearest = 0.05F;

void clear(Rendering& out, const Camera& camera, const BodyMesh& mesh) {
  const auto pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (out.width != camera.width || out.height != camera.height) {
    out.width = camera.width;
    out.height = camera.height;
    out.surface.assign(pixels, 0);
    out.inverse_depth.assign(pixels, 0.0F);
  } else {
    const int span = out.right - out.left;
    for (int y = out.top; y < out.bottom && span > 0; ++y) {
      const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y) * out.width + out.left;
      std::fill_n(out.surface.begin() + row, span, std::uint8_t{0});
      std::fill_n(out.inverse_depth.begin() + row, span, 0.0F);
    }
  }
  out.left = camera.width;
  out.top = camera.height;
  out.right = 0;
  out.bottom = 0;
  out.projected.resize(mesh.vertices.size());
  out.facing.resize(mesh.triangles.size());
}

void project(const BodyMesh& mesh, const Kinematics& kinematics, const Camera& camera, Rendering& out) {
  const auto fx = static_cast<float>(camera.fx);
  const auto fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx);
  const auto cy = static_cast<float>(camera.cy);
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    const Eigen::Matrix3f r = kinematics.camera_from_segment[s].linear().cast<float>();
    const Eigen::Vector3f t = kinematics.camera_from_segment[s].translation().cast<float>();
    for (auto i = mesh.vertex_range[s].begin; i < mesh.vertex_range[s].end; ++i) {
      const Eigen::Vector3f p = r * mesh.vertices[i] + t;
      if (p.z() < kNearest) {
        out.projected[i] = {0.0F, 0.0F, 0.0F};  // 1/z = 0 marks it
        continue;
      }
      const float w = 1.0F / p.z();
      out.projected[i] = {fx * p.x() * w + cx, fy * p.y() * w + cy, w};
    }
  }
}

struct HalfPlane {
  float slope;   // of the crossing x over y
  float offset;  // crossing x at y = 0
  int kind;      // +1: x must be at least the crossing, -1: at most, 0: horizontal edge, no bound
};

// The inside of a front-facing triangle lies to one side of each of its edges.
HalfPlane half_plane(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const float dy = b.y() - a.y();
  if (dy == 0.0F) {
    return {0.0F, 0.0F, 0};
  }
  const float slope = (b.x() - a.x()) / dy;
  return {slope, a.x() - slope * a.y(), dy > 0.0F ? 1 : -1};
}

void fill(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c, float area,
          std::uint8_t surface, Rendering& out) {
  const float low_y = std::min({a.y(), b.y(), c.y()});
  const float high_y = std::max({a.y(), b.y(), c.y()});
  const float low_x = std::min({a.x(), b.x(), c.x()});
  const float high_x = std::max({a.x(), b.x(), c.x()});
  const auto limit = static_cast<float>(1 << 20);
  if (high_y < 0.0F || high_x < 0.0F || low_y > static_cast<float>(out.height - 1) ||
      low_x > static_cast<float>(out.width - 1) || low_y < -limit || high_y > limit || low_x < -limit ||
      high_x > limit) {
    return;
  }
  const int y0 = std::max(0, static_cast<int>(std::ceil(low_y)));
  const int y1 = std::min(out.height - 1, static_cast<int>(std::floor(high_y)));
  const float bound_low = std::max(0.0F, low_x);
  const float bound_high = std::min(static_cast<float>(out.width - 1), high_x);
  if (y0 > y1 || std::ceil(bound_low) > std::floor(bound_high)) {
    return;
  }
  const HalfPlane sides[3] = {half_plane(a, b), half_plane(b, c), half_plane(c, a)};
  // 1/z is linear in the image.
  const float inverse_area = 1.0F / area;
  const float w_x = ((b.z() - a.z()) * (c.y() - a.y()) - (c.z() - a.z()) * (b.y() - a.y())) * inverse_area;
  const float w_y = ((c.z() - a.z()) * (b.x() - a.x()) - (b.z() - a.z()) * (c.x() - a.x())) * inverse_area;
  const float w_0 = a.z() - w_x * a.x() - w_y * a.y();

  for (int y = y0; y <= y1; ++y) {
    const auto fy = static_cast<float>(y);
    float low = bound_low;
    float high = bound_high;
    for (const HalfPlane& side : sides) {
      const float x = side.slope * fy + side.offset;
      low = side.kind > 0 ? std::max(low, x) : low;
      high = side.kind < 0 ? std::min(high, x) : high;
    }
    const int x0 = static_cast<int>(std::ceil(low));
    const int x1 = static_cast<int>(std::floor(high));
    if (x0 > x1) {
      continue;
    }
    out.left = std::min(out.left, x0);
    out.right = std::max(out.right, x1 + 1);
    out.top = std::min(out.top, y);
    out.bottom = std::max(out.bottom, y + 1);
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width);
    float* depth = out.inverse_depth.data() + row;
    std::uint8_t* plane = out.surface.data() + row;
    const float w_row = w_0 + w_y * fy;
    for (int x = x0; x <= x1; ++x) {
      const float w = w_row + w_x * static_cast<float>(x);
      const bool nearer = w > depth[x];
      depth[x] = nearer ? w : depth[x];
      plane[x] = nearer ? surface : plane[x];
    }
  }
}

}  // namespace

void render(const BodyMesh& mesh, const Kinematics& kinematics, const Camera& camera, Rendering& out) {
  clear(out, camera, mesh);
  project(mesh, kinematics, camera, out);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const MeshTriangle& triangle = mesh.triangles[i];
    const Eigen::Vector3f& a = out.projected[triangle.vertex[0]];
    const Eigen::Vector3f& b = out.projected[triangle.vertex[1]];
    const Eigen::Vector3f& c = out.projected[triangle.vertex[2]];
    if (a.z() == 0.0F || b.z() == 0.0F || c.z() == 0.0F) {
      out.facing[i] = 0;
      continue;
    }
    // y points down in the image: counter-clockwise from outside has negative area in (u, v).
    const float area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
    if (area < 0.0F) {
      out.facing[i] = 1;
      fill(a, b, c, area, static_cast<std::uint8_t>(triangle.surface), out);
    } else {
      out.facing[i] = -1;
    }
  }
}

void occluding_contour(const BodyMesh& mesh, const Rendering& rendering, std::vector<Eigen::Vector2f>& out) {
  // The contour of a segment lies about half a limb's thickness behind its nearest surface: what is hidden by
  // less than this (m) is hidden by the segment itself or where two segments join.
  constexpr float kThickness = 0.015F;
  out.clear();
  for (const MeshEdge& edge : mesh.edges) {
    const int front = rendering.facing[edge.triangle[0]];
    const int back = rendering.facing[edge.triangle[1]];
    if (front * back != -1) {
      continue;
    }
    const Eigen::Vector3f& a = rendering.projected[edge.vertex[0]];
    const Eigen::Vector3f& b = rendering.projected[edge.vertex[1]];
    const Eigen::Vector3f d = b - a;
    const float length = std::hypot(d.x(), d.y());
    if (!(length < 4096.0F)) {
      continue;
    }
    const int steps = std::max(1, static_cast<int>(std::lround(length)));
    for (int i = 0; i < steps; ++i) {
      const Eigen::Vector3f p = a + d * ((static_cast<float>(i) + 0.5F) / static_cast<float>(steps));
      const auto x = static_cast<int>(std::lround(p.x()));
      const auto y = static_cast<int>(std::lround(p.y()));
      if (x < 0 || y < 0 || x >= rendering.width || y >= rendering.height) {
        continue;
      }
      const float nearest =
          rendering.inverse_depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(rendering.width) +
                                  static_cast<std::size_t>(x)];
      // Depth of the sample minus depth of what the pixel shows, without dividing: 1/p.z - 1/nearest.
      if (nearest - p.z() > kThickness * nearest * p.z()) {
        continue;
      }
      out.emplace_back(p.x(), p.y());
    }
  }
}

}  // namespace telemime
