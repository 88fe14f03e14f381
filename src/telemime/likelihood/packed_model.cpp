// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/packed_model.h"

#include <cstring>
#include <string>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr std::uint32_t kAlignment = 16;

void add(PackedSegment::LaneSet& set, std::uint32_t lane) {
  set[lane / 64] |= std::uint64_t{1} << (lane % 64);
}

// A search asks for each pose: comparing number by number takes a tenth of an evaluation.
bool same_bytes(const std::vector<Eigen::Vector3f>& a, const std::vector<Eigen::Vector3f>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Eigen::Vector3f)) == 0;
}

std::array<float, 3> floats(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

PackedSkeleton packed_skeleton(const Body& body) {
  PackedSkeleton out;
  out.neck_from_root = floats(body.neck_from_root);
  for (const Side side : {Side::left, Side::right}) {
    const auto i = static_cast<std::size_t>(side);
    out.shoulder_from_root[i] = floats(shoulder_in_chest(body, side, {0.0, -1.0, 0.0}));
    out.upper_arm[i] = static_cast<float>(body.upper_arm_length[i]);
    out.forearm[i] = static_cast<float>(body.forearm_length[i]);
  }
  out.clavicle_lift = static_cast<float>(body.clavicle_lift);
  out.clavicle_reach = static_cast<float>(body.clavicle_reach);
  return out;
}

std::uint32_t stride_of(const RingStack& stack) {
  return stack.rings + 2;
}
std::uint32_t vertices_of(const RingStack& stack) {
  return (stack.sides + 1) * stride_of(stack);
}

void pack_segment(const BodyMesh& mesh, std::size_t s, std::uint32_t begin, PackedModel& out) {
  const RingStack& stack = mesh.stacks[s];
  PackedSegment& segment = out.segments[s];
  segment = {};
  segment.begin = begin;
  segment.stride = stride_of(stack);
  segment.lanes = stack.sides * segment.stride;
  if (stack.rings == 0 || segment.stride >= 64 || vertices_of(stack) > PackedSegment::kMostLanes) {
    throw Error(ErrorKind::usage, "the mesh of " + std::string(kSegmentNames[s]) +
                                      " is not a stack of rings, or has too many of them");
  }
  const std::uint32_t first = mesh.vertex_range[s].begin;
  const std::uint32_t ends = first + stack.rings * stack.sides;
  for (std::uint32_t j = 0; j <= stack.sides; ++j) {
    for (std::uint32_t row = 0; row < segment.stride; ++row) {
      const bool top = row == 0;
      const bool bottom = row == stack.rings + 1;
      const std::uint32_t v =
          top || bottom ? ends + (bottom ? 1 : 0) : first + (row - 1) * stack.sides + j % stack.sides;
      const std::uint32_t lane = j * segment.stride + row;
      out.x[begin + lane] = mesh.vertices[v].x();
      out.y[begin + lane] = mesh.vertices[v].y();
      out.z[begin + lane] = mesh.vertices[v].z();
      if (j == stack.sides || bottom) {
        continue;
      }
      add(segment.quads, lane);
      std::uint32_t mark = 0;
      if (top) {
        add(segment.top, lane);
        mark = PackedModel::kTop;
      }
      if (row == stack.rings) {
        add(segment.bottom, lane);
        mark |= PackedModel::kBottom;
      }
      out.surface[begin + lane] =
          static_cast<std::uint32_t>(stack.surface[row]) << PackedModel::kClassShift | mark;
    }
  }
}

}  // namespace

void pack(const Body& body, const BodyMesh& mesh, PackedModel& out) {
  out.content = std::make_shared<char>();
  out.skeleton = packed_skeleton(body);
  std::array<std::uint32_t, kSegmentCount> begin{};
  std::uint32_t size = 0;
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    begin[s] = size;
    size += vertices_of(mesh.stacks[s]);
    size = (size + kAlignment - 1) / kAlignment * kAlignment;
  }
  size += PackedModel::kPadding;
  for (std::vector<float>* coordinate : {&out.x, &out.y, &out.z}) {
    coordinate->assign(size, 0.0F);
  }
  out.surface.assign(size, 0);
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    pack_segment(mesh, s, begin[s], out);
  }
}

const PackedModel& PackedModelCache::of(const Body& body, const BodyMesh& mesh) {
  bool same = known_ && packed_skeleton(body) == packed_.skeleton && same_bytes(mesh.vertices, vertices_);
  for (std::size_t s = 0; s < kSegmentCount && same; ++s) {
    same = mesh.stacks[s] == stacks_[s];
  }
  if (!same) {
    known_ = false;  // until all of it is packed
    pack(body, mesh, packed_);
    stacks_ = mesh.stacks;
    vertices_ = mesh.vertices;
    known_ = true;
  }
  return packed_;
}

}  // namespace telemime
