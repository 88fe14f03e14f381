// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/packed_model.h"

#include <string>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr std::uint32_t kAlignment = 16;

void add(PackedSegment::LaneSet& set, std::uint32_t lane) {
  set[lane / 64] |= std::uint64_t{1} << (lane % 64);
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

void pack_segment(const BodyMesh& mesh, std::size_t s, std::uint32_t begin, PackedModel& out) {
  const RingStack& stack = mesh.stacks[s];
  PackedSegment& segment = out.segments[s];
  segment = {};
  segment.begin = begin;
  segment.stride = stack.sides + 1;
  segment.vertices = (stack.rings + 2) * segment.stride;
  segment.lanes = (stack.rings + 1) * segment.stride;
  if (stack.rings == 0 || segment.lanes + kAlignment > PackedSegment::kMostLanes) {
    throw Error(ErrorKind::usage, "the mesh of " + std::string(kSegmentNames[s]) +
                                      " is no stack of rings or has too many of them");
  }
  const std::uint32_t first = mesh.vertex_range[s].begin;
  const std::uint32_t top = first + stack.rings * stack.sides;
  std::uint32_t at = begin;
  for (std::uint32_t ring = 0; ring < stack.rings + 2; ++ring) {
    for (std::uint32_t j = 0; j < segment.stride; ++j, ++at) {
      const bool end = ring == 0 || ring == stack.rings + 1;
      const std::uint32_t v =
          end ? top + (ring == 0 ? 0 : 1) : first + (ring - 1) * stack.sides + j % stack.sides;
      out.x[at] = mesh.vertices[v].x();
      out.y[at] = mesh.vertices[v].y();
      out.z[at] = mesh.vertices[v].z();
    }
  }
  for (std::uint32_t lane = 0; lane < segment.lanes; ++lane) {
    const std::uint32_t j = lane % segment.stride;
    out.surface[begin + lane] = static_cast<std::uint32_t>(stack.surface[lane / segment.stride])
                                << PackedModel::kClassShift;
    if (j < stack.sides) {
      add(segment.quads, lane);
    }
    if (j == 0) {
      add(segment.first, lane);
    }
  }
}

}  // namespace

void pack(const Body& body, const BodyMesh& mesh, PackedModel& out) {
  out.skeleton = packed_skeleton(body);
  std::array<std::uint32_t, kSegmentCount> begin{};
  std::uint32_t size = 0;
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    begin[s] = size;
    size += (mesh.stacks[s].rings + 2) * (mesh.stacks[s].sides + 1);
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
  bool same = packed_skeleton(body) == packed_.skeleton && mesh.vertices == vertices_;
  for (std::size_t s = 0; s < kSegmentCount && same; ++s) {
    same = mesh.stacks[s].surface == surfaces_[s];
  }
  if (!same) {
    pack(body, mesh, packed_);
    vertices_ = mesh.vertices;
    for (std::size_t s = 0; s < kSegmentCount; ++s) {
      surfaces_[s] = mesh.stacks[s].surface;
    }
  }
  return packed_;
}

}  // namespace telemime
