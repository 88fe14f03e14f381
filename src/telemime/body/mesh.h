// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "telemime/body/body.h"

namespace telemime {

/// Colour class of a part of the surface; the values equal those of Label.
enum class SurfaceClass : std::uint8_t { head = 1, arms = 2, clothes = 3 };
inline constexpr std::size_t kSurfaceClassCount = 3;

struct Range {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

struct MeshTriangle {
  std::array<std::uint32_t, 3> vertex{};  ///< counter-clockwise seen from outside
  SurfaceClass surface = SurfaceClass::clothes;
};

struct MeshEdge {
  std::array<std::uint32_t, 2> vertex{};
  std::array<std::uint32_t, 2> triangle{};  ///< the two adjacent triangles
};

/// The layout of a segment's mesh: rings of vertices from top to bottom, `sides` each, then the vertices that
/// close the top and the bottom. `surface` has the class of each strip between them: top cap, strips from
/// ring to ring, bottom cap.
struct RingStack {
  std::uint32_t rings = 0;
  std::uint32_t sides = 0;
  std::vector<SurfaceClass> surface;  ///< rings + 1
  bool operator==(const RingStack&) const = default;
};

/// Closed polygon meshes of the eight segments (thesis 2.4.1), each in its segment's frame, metres. Vertices,
/// triangles and edges of a segment are contiguous.
struct BodyMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<MeshTriangle> triangles;
  std::vector<MeshEdge> edges;
  std::array<Range, kSegmentCount> vertex_range{};
  std::array<Range, kSegmentCount> triangle_range{};
  std::array<Range, kSegmentCount> edge_range{};
  std::array<RingStack, kSegmentCount> stacks{};
};

/// Meshes for a body: stacks of elliptic rings scaled by the shape, radii from the segment girths of
/// NASA-STD-3000 (1995, volume I, section 3.3), with a ring where the sleeve ends.
BodyMesh make_mesh(const Body& body);

}  // namespace telemime
