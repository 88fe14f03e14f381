// SPDX-License-Identifier: Apache-2.0
#include "telemime/render/renderer.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace telemime {
namespace {

constexpr float kNearest = 0.05F;
// Number of pixels that fill() tests at once.
constexpr int kLanes = 4;

void clear(Rendering& out, const Camera& camera, const BodyMesh& mesh) {
  const auto pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (out.width != camera.width || out.height != camera.height) {
    out.width = camera.width;
    out.height = camera.height;
    // fill_lanes() reads and rewrites, unchanged, up to four pixels after the last one.
    out.surface.assign(pixels + kLanes, 0);
    out.inverse_depth.assign(pixels + kLanes, 0.0F);
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

void project(SegmentSet which, const BodyMesh& mesh, const Kinematics& kinematics, const Camera& camera,
             Rendering& out) {
  const auto fx = static_cast<float>(camera.fx);
  const auto fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx);
  const auto cy = static_cast<float>(camera.cy);
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    if (!which[s]) {
      continue;
    }
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

// Rounding without calls into the C library, also for processors without rounding instructions. Exact for |x|
// < 2^23; fill() and occluding_contour() drop larger coordinates before.
int floor_of(float x) {
  const int whole = static_cast<int>(x);
  return whole - (static_cast<float>(whole) > x ? 1 : 0);
}
int ceil_of(float x) {
  const int whole = static_cast<int>(x);
  return whole + (static_cast<float>(whole) < x ? 1 : 0);
}
// Rounds half away from zero, as std::lround does.
int nearest_to(float x) {
  const int whole = static_cast<int>(x);
  const float rest = x - static_cast<float>(whole);
  return whole + (rest >= 0.5F ? 1 : 0) - (rest <= -0.5F ? 1 : 0);
}

// Four rows or pixels at once. Most triangles are only a few pixels large: loops over single pixels would
// spend their time on mispredicted ends.
using Floats = float __attribute__((vector_size(16)));
using Ints = std::int32_t __attribute__((vector_size(16)));

Floats floats(Ints x) {
  return __builtin_convertvector(x, Floats);
}
// Rounding of four numbers; a comparison gives -1 where it is true.
Ints floors(Floats x) {
  const Ints whole = __builtin_convertvector(x, Ints);
  return whole + (floats(whole) > x);
}
Ints ceils(Floats x) {
  const Ints whole = __builtin_convertvector(x, Ints);
  return whole - (floats(whole) < x);
}
// As std::max and std::min: the first argument where the second is not a number.
Floats larger(Floats a, Floats b) {
  return a < b ? b : a;
}
Floats smaller(Floats a, Floats b) {
  return b < a ? b : a;
}

// Intersection of a triangle's edge with a row: x = slope * y + offset.
struct Crossing {
  float slope = 0.0F;
  float offset = 0.0F;
  Floats at(Floats y) const { return slope * y + offset; }
};

// The inside of a front-facing triangle is right of edges that go down and left of edges that go up. At most
// two of the three edges bound the same side; unused bounds are infinite. Horizontal edges bound no row.
struct RowBounds {
  Crossing left[2] = {{0.0F, -std::numeric_limits<float>::infinity()},
                      {0.0F, -std::numeric_limits<float>::infinity()}};
  Crossing right[2] = {{0.0F, std::numeric_limits<float>::infinity()},
                       {0.0F, std::numeric_limits<float>::infinity()}};
  int lefts = 0;
  int rights = 0;

  void add(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    const float dy = b.y() - a.y();
    if (dy == 0.0F) {
      return;
    }
    const float slope = (b.x() - a.x()) / dy;
    (dy > 0.0F ? left[lefts++] : right[rights++]) = {slope, a.x() - slope * a.y()};
  }
};

// The bytes of `classes` are in the order of the pixels in memory.
static_assert(std::endian::native == std::endian::little);

// The z-buffer test for the pixels x..x+3 up to `last`; 1/z = w_row + w_x * x.
void fill_lanes(float* depth, std::uint8_t* plane, int x, int last, float w_row, float w_x,
                std::uint8_t surface) {
  const Ints at = Ints{0, 1, 2, 3} + x;
  const Floats w = w_row + w_x * floats(at);
  Floats before;
  std::memcpy(&before, depth, sizeof before);
  const Ints nearer = (w > before) & (at <= last);
  const Floats after = nearer ? w : before;
  std::memcpy(depth, &after, sizeof after);
  // Pack the masks of the lanes into one word, one byte each.
  Ints bytes = nearer & Ints{0x000000FF, 0x0000FF00, 0x00FF0000, ~0x00FFFFFF};
  bytes |= __builtin_shufflevector(bytes, bytes, 2, 3, 0, 1);
  bytes |= __builtin_shufflevector(bytes, bytes, 1, 0, 3, 2);
  const auto changed = static_cast<std::uint32_t>(bytes[0]);
  std::uint32_t classes = 0;
  std::memcpy(&classes, plane, sizeof classes);
  classes = (classes & ~changed) | (changed & (surface * 0x01010101U));
  std::memcpy(plane, &classes, sizeof classes);
}

void fill(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c, float area,
          std::uint8_t surface, Rendering& out) {
  // Rows and columns of the triangle inside the image.
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
  const int y0 = std::max(0, ceil_of(low_y));
  const int y1 = std::min(out.height - 1, floor_of(high_y));
  const float bound_low = std::max(0.0F, low_x);
  const float bound_high = std::min(static_cast<float>(out.width - 1), high_x);
  const int first_x = ceil_of(bound_low);
  const int last_x = floor_of(bound_high);
  if (y0 > y1 || first_x > last_x) {
    return;
  }
  // Bounds of each row from the edges, and the plane of 1/z, which is linear in the image.
  RowBounds bounds;
  bounds.add(a, b);
  bounds.add(b, c);
  bounds.add(c, a);
  const float inverse_area = 1.0F / area;
  const float w_x = ((b.z() - a.z()) * (c.y() - a.y()) - (c.z() - a.z()) * (b.y() - a.y())) * inverse_area;
  const float w_y = ((c.z() - a.z()) * (b.x() - a.x()) - (b.z() - a.z()) * (c.x() - a.x())) * inverse_area;
  const float w_0 = a.z() - w_x * a.x() - w_y * a.y();

  out.left = std::min(out.left, first_x);
  out.right = std::max(out.right, last_x + 1);
  out.top = std::min(out.top, y0);
  out.bottom = std::max(out.bottom, y1 + 1);

  // Four rows at a time, four pixels of a row at a time.
  const auto width = static_cast<std::size_t>(out.width);
  const std::size_t first = static_cast<std::size_t>(y0) * width;
  float* depth = out.inverse_depth.data() + first;
  std::uint8_t* plane = out.surface.data() + first;
  for (int y = y0; y <= y1; y += kLanes) {
    const Floats fy = floats(Ints{0, 1, 2, 3} + y);
    Floats low = larger(larger(Floats{} + bound_low, bounds.left[0].at(fy)), bounds.left[1].at(fy));
    Floats high = smaller(smaller(Floats{} + bound_high, bounds.right[0].at(fy)), bounds.right[1].at(fy));
    // Rows that miss the triangle stay empty but small enough to be rounded.
    low = smaller(low, Floats{} + (bound_high + 1.0F));
    high = larger(high, Floats{} + (bound_low - 1.0F));
    const Ints x0 = ceils(low);
    const Ints x1 = floors(high);
    const Floats w_row = w_0 + w_y * fy;
    const int rows = std::min(kLanes, y1 + 1 - y);
    for (int k = 0; k < rows; ++k, depth += width, plane += width) {
      int x = x0[k];
      do {  // at least once: an empty row is rare and harmless
        fill_lanes(depth + x, plane + x, x, x1[k], w_row[k], w_x, surface);
        x += kLanes;
      } while (x <= x1[k]);
    }
  }
}

void draw(Range triangles, const BodyMesh& mesh, Rendering& out) {
  for (auto i = triangles.begin; i < triangles.end; ++i) {
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

}  // namespace

void render(const BodyMesh& mesh, const Kinematics& kinematics, const Camera& camera, Rendering& out) {
  clear(out, camera, mesh);
  project(SegmentSet{}.set(), mesh, kinematics, camera, out);
  draw({0, static_cast<std::uint32_t>(mesh.triangles.size())}, mesh, out);
}

void render_segments(SegmentSet which, const BodyMesh& mesh, const Kinematics& kinematics,
                     const Camera& camera, Rendering& out) {
  clear(out, camera, mesh);
  project(which, mesh, kinematics, camera, out);
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    if (which[s]) {
      draw(mesh.triangle_range[s], mesh, out);
    }
  }
}

void occluding_contour(const BodyMesh& mesh, const Rendering& rendering, std::vector<Eigen::Vector2f>& out) {
  // The contour of a segment is about half a limb's thickness behind its nearest surface: a point that is
  // hidden by less than this (m) is hidden by its own segment or at a joint.
  constexpr float kThickness = 0.015F;
  const auto width = static_cast<float>(rendering.width);
  const auto height = static_cast<float>(rendering.height);
  out.clear();
  for (const MeshEdge& edge : mesh.edges) {
    // Only edges between a front-facing and a back-facing triangle.
    if (rendering.facing[edge.triangle[0]] * rendering.facing[edge.triangle[1]] != -1) {
      continue;
    }
    const Eigen::Vector3f& a = rendering.projected[edge.vertex[0]];
    const Eigen::Vector3f& b = rendering.projected[edge.vertex[1]];
    const Eigen::Vector3f d = b - a;
    const float length = d.head<2>().norm();
    if (!(length < 4096.0F)) {
      continue;
    }
    // About one sample per pixel; keep those inside the image that nothing hides.
    const int steps = std::max(1, nearest_to(length));
    for (int i = 0; i < steps; ++i) {
      const Eigen::Vector3f p = a + d * ((static_cast<float>(i) + 0.5F) / static_cast<float>(steps));
      if (!(p.x() > -1.0F && p.y() > -1.0F && p.x() < width && p.y() < height)) {
        continue;
      }
      const int x = nearest_to(p.x());
      const int y = nearest_to(p.y());
      if (x < 0 || y < 0 || x >= rendering.width || y >= rendering.height) {
        continue;
      }
      const float nearest =
          rendering.inverse_depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(rendering.width) +
                                  static_cast<std::size_t>(x)];
      // Depth of the sample minus depth of the pixel, 1/p.z - 1/nearest, without dividing.
      if (nearest - p.z() > kThickness * nearest * p.z()) {
        continue;
      }
      out.emplace_back(p.x(), p.y());
    }
  }
}

}  // namespace telemime
