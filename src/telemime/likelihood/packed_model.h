// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "telemime/body/body.h"
#include "telemime/body/mesh.h"
#include "telemime/likelihood/gpu/device.h"

namespace telemime {

/// A person's surface laid out for vector processors. A segment is a grid of vertices, one side after the
/// other: from its top end down its rings to its bottom end (each end is a ring of one point). The first side
/// is repeated at the end. The quadrilateral of lane i therefore has the corners i, i + stride (on the next
/// side) and, below them, i + 1 and i + stride + 1: no indices are needed, and sides that face away are
/// adjacent. The last lane of each side has no quadrilateral; `quads` says which lanes have one.
struct PackedSegment {
  static constexpr std::uint32_t kMostLanes = 256;
  using LaneSet = std::array<std::uint64_t, kMostLanes / 64>;

  std::uint32_t begin = 0;   ///< first of its vertices and lanes in the model's arrays, a multiple of 16
  std::uint32_t lanes = 0;   ///< sides x stride; there are `stride` more vertices
  std::uint32_t stride = 0;  ///< rings + 2, at most 63
  LaneSet quads{};           ///< lanes with a quadrilateral
  LaneSet top{};             ///< those at the top end: they have no triangle (a, b, c)
  LaneSet bottom{};          ///< those at the bottom end: they have no triangle (b, d, c)
};

/// All data of a person that an evaluation needs.
struct PackedModel {
  /// Bits of a surface class in the lowest five bits of a depth: 8 times the class.
  static constexpr std::uint32_t kClassShift = 3;
  /// Marks of lanes at a segment's ends.
  static constexpr std::uint32_t kTop = 0x100;
  static constexpr std::uint32_t kBottom = 0x200;
  /// Number of lanes that a vector load may read after a segment's last one.
  static constexpr std::uint32_t kPadding = 48;

  PackedSkeleton skeleton;
  std::array<PackedSegment, kSegmentCount> segments{};
  std::vector<float> x, y, z;           ///< vertices, m, segment's frame
  std::vector<std::uint32_t> surface;   ///< by lane: the strip's class << kClassShift, and marks
  std::shared_ptr<const void> content;  ///< another one after each pack()
};

/// Packs a mesh made by make_mesh() into `out`, whose memory is reused. Throws Error(usage) for a segment of
/// more than kMostLanes.
void pack(const Body& body, const BodyMesh& mesh, PackedModel& out);

/// Caches the last packed model, since a search uses the same one repeatedly. Compares the contents, so that
/// a model that was changed in place is packed again.
class PackedModelCache {
 public:
  const PackedModel& of(const Body& body, const BodyMesh& mesh);

 private:
  PackedModel packed_;
  bool known_ = false;
  std::vector<Eigen::Vector3f> vertices_;
  std::array<RingStack, kSegmentCount> stacks_;
};

}  // namespace telemime
