// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/packed_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <tuple>

#include "telemime/body/testing_poses.h"
#include "telemime/core/testing_errors.h"
#include "telemime/likelihood/backend.h"

namespace telemime {
namespace {

using Lanes = PackedSegment::LaneSet;

bool has(const Lanes& set, std::uint32_t lane) {
  return (set[lane / 64] >> (lane % 64) & 1U) != 0;
}

Shape with_sleeve(double sleeve) {
  Shape shape;
  shape.sleeve = sleeve;
  return shape;
}

std::vector<Model> models() {
  return {make_model(Shape{}), make_model(testing_poses::other_shape()), make_model(with_sleeve(0.0)),
          make_model(with_sleeve(1.4)), make_model(with_sleeve(2.0))};
}

PackedModel packed(const Model& model) {
  PackedModel out;
  pack(model.body, model.mesh, out);
  return out;
}

Eigen::Vector3f vertex(const PackedModel& p, std::size_t at) {
  return {p.x[at], p.y[at], p.z[at]};
}

// A triangle by the indices of its vertices, the smallest first, with the same orientation; and its class.
using Triangle = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
Triangle triangle(std::array<std::uint32_t, 3> v, std::uint32_t surface) {
  std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
  return {v[0], v[1], v[2], surface};
}

// Index in the mesh of a packed vertex, found by position: all vertices of a segment differ in position.
std::uint32_t number_in_mesh(const BodyMesh& mesh, std::size_t segment, const Eigen::Vector3f& place) {
  std::uint32_t found = mesh.vertex_range[segment].end;
  int times = 0;
  for (auto i = mesh.vertex_range[segment].begin; i < mesh.vertex_range[segment].end; ++i) {
    if (mesh.vertices[i] == place) {
      found = i;
      ++times;
    }
  }
  EXPECT_EQ(times, 1);
  return found;
}

// Twice the area, m^2.
float area(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  return (b - a).cross(c - a).norm();
}

TEST(PackedModel, SegmentsArePaddedForVectors) {
  for (const Model& model : models()) {
    const PackedModel p = packed(model);
    std::uint32_t end = 0;
    for (std::size_t s = 0; s < kSegmentCount; ++s) {
      const PackedSegment& segment = p.segments[s];
      EXPECT_EQ(segment.begin % 16, 0U);
      EXPECT_GE(segment.begin, end);
      EXPECT_EQ(segment.stride, model.mesh.stacks[s].rings + 2);
      EXPECT_EQ(segment.lanes, model.mesh.stacks[s].sides * segment.stride);
      end = segment.begin + segment.lanes + segment.stride;
    }
    for (const std::size_t size : {p.x.size(), p.y.size(), p.z.size(), p.surface.size()}) {
      EXPECT_GE(size, end + PackedModel::kPadding);
    }
  }
}

TEST(PackedModel, EveryVertexIsAtItsPlaceOfTheGrid) {
  for (const Model& model : models()) {
    const PackedModel p = packed(model);
    for (std::size_t s = 0; s < kSegmentCount; ++s) {
      const RingStack& stack = model.mesh.stacks[s];
      const Eigen::Vector3f* mesh = &model.mesh.vertices[model.mesh.vertex_range[s].begin];
      const std::uint32_t ends = stack.rings * stack.sides;  // after the rings: top, then bottom
      for (std::uint32_t side = 0; side <= stack.sides; ++side) {
        const std::size_t column = p.segments[s].begin + side * p.segments[s].stride;
        EXPECT_EQ(vertex(p, column), mesh[ends]);
        for (std::uint32_t ring = 0; ring < stack.rings; ++ring) {
          EXPECT_EQ(vertex(p, column + 1 + ring), mesh[ring * stack.sides + side % stack.sides])
              << kSegmentNames[s] << " ring " << ring << " side " << side;
        }
        EXPECT_EQ(vertex(p, column + 1 + stack.rings), mesh[ends + 1]);
      }
    }
  }
}

TEST(PackedModel, LanesAreTheTrianglesOfTheMeshEachOnce) {
  for (const Model& model : models()) {
    const PackedModel p = packed(model);
    for (std::size_t s = 0; s < kSegmentCount; ++s) {
      SCOPED_TRACE(kSegmentNames[s]);
      const PackedSegment& segment = p.segments[s];
      std::vector<Triangle> lanes;
      for (std::uint32_t i = 0; i < segment.lanes; ++i) {
        if (!has(segment.quads, i)) {
          continue;
        }
        const auto corner = [&](std::uint32_t k) {
          return number_in_mesh(model.mesh, s, vertex(p, segment.begin + i + k));
        };
        const std::uint32_t a = corner(0);
        const std::uint32_t b = corner(segment.stride);
        const std::uint32_t c = corner(1);
        const std::uint32_t d = corner(segment.stride + 1);
        const std::uint32_t surface = (p.surface[segment.begin + i] & 0x1F) >> PackedModel::kClassShift;
        if (has(segment.top, i)) {
          EXPECT_EQ(a, b);
        } else {
          lanes.push_back(triangle({a, b, c}, surface));
        }
        if (has(segment.bottom, i)) {
          EXPECT_EQ(c, d);
        } else {
          lanes.push_back(triangle({b, d, c}, surface));
        }
      }
      std::vector<Triangle> mesh;
      for (auto t = model.mesh.triangle_range[s].begin; t < model.mesh.triangle_range[s].end; ++t) {
        const MeshTriangle& m = model.mesh.triangles[t];
        mesh.push_back(triangle(m.vertex, static_cast<std::uint32_t>(m.surface)));
      }
      std::sort(lanes.begin(), lanes.end());
      std::sort(mesh.begin(), mesh.end());
      EXPECT_EQ(lanes, mesh);
    }
  }
}

TEST(PackedModel, MarksSayWhatTheSetsSay) {
  for (const Model& model : models()) {
    const PackedModel p = packed(model);
    for (std::size_t s = 0; s < kSegmentCount; ++s) {
      const PackedSegment& segment = p.segments[s];
      const RingStack& stack = model.mesh.stacks[s];
      for (std::uint32_t i = 0; i < PackedSegment::kMostLanes; ++i) {
        const std::uint32_t row = i % segment.stride;
        const bool quad = i < segment.lanes && row <= stack.rings;
        ASSERT_EQ(has(segment.quads, i), quad) << i;
        ASSERT_EQ(has(segment.top, i), quad && row == 0) << i;
        ASSERT_EQ(has(segment.bottom, i), quad && row == stack.rings) << i;
        if (i < segment.lanes) {
          const std::uint32_t strip = quad ? static_cast<std::uint32_t>(stack.surface[row]) : 0;
          const std::uint32_t marks = (quad && row == 0 ? PackedModel::kTop : 0) |
                                      (quad && row == stack.rings ? PackedModel::kBottom : 0);
          ASSERT_EQ(p.surface[segment.begin + i], strip << PackedModel::kClassShift | marks) << i;
        }
      }
    }
  }
}

TEST(PackedModel, LanesWithoutAQuadrilateralHaveNoArea) {
  const PackedModel p = packed(make_model(Shape{}));
  for (const PackedSegment& segment : p.segments) {
    for (std::uint32_t i = 0; i < segment.lanes; ++i) {
      if (has(segment.quads, i)) {
        continue;
      }
      const auto corner = [&](std::uint32_t k) { return vertex(p, segment.begin + i + k); };
      EXPECT_EQ(area(corner(0), corner(segment.stride), corner(1)), 0.0F);
      // The fourth corner of the last lane is after the last side: not a vertex of this segment.
      if (i + 1 < segment.lanes) {
        EXPECT_EQ(area(corner(segment.stride), corner(segment.stride + 1), corner(1)), 0.0F);
      }
    }
  }
}

TEST(PackedModel, SkeletonIsTheOneOfThePosesAtRest) {
  const Model model = make_model(testing_poses::other_shape());
  const PackedSkeleton skeleton = packed(model).skeleton;
  const Kinematics rest = forward_kinematics(model.body, Pose{});
  const auto joint = [&](Segment from, Segment to) -> Eigen::Vector3f {
    return (rest[from].inverse() * rest[to].translation()).cast<float>();
  };
  const auto near = [](const std::array<float, 3>& a, const Eigen::Vector3f& b) {
    return (Eigen::Vector3f(a[0], a[1], a[2]) - b).norm() < 1e-6F;
  };
  EXPECT_TRUE(near(skeleton.neck_from_root, joint(Segment::chest, Segment::head)));
  EXPECT_TRUE(near(skeleton.shoulder_from_root[0], joint(Segment::chest, Segment::l_upper_arm)));
  EXPECT_TRUE(near(skeleton.shoulder_from_root[1], joint(Segment::chest, Segment::r_upper_arm)));
  EXPECT_NEAR(skeleton.upper_arm[0], joint(Segment::l_upper_arm, Segment::l_forearm).norm(), 1e-6);
  EXPECT_NEAR(skeleton.upper_arm[1], joint(Segment::r_upper_arm, Segment::r_forearm).norm(), 1e-6);
  EXPECT_NEAR(skeleton.forearm[0], joint(Segment::l_forearm, Segment::l_hand).norm(), 1e-6);
  EXPECT_NEAR(skeleton.forearm[1], joint(Segment::r_forearm, Segment::r_hand).norm(), 1e-6);
}

void expect_equal(const PackedModel& a, const PackedModel& b) {
  EXPECT_EQ(a.skeleton, b.skeleton);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.surface, b.surface);
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    EXPECT_EQ(a.segments[s].begin, b.segments[s].begin);
    EXPECT_EQ(a.segments[s].lanes, b.segments[s].lanes);
    EXPECT_EQ(a.segments[s].stride, b.segments[s].stride);
    EXPECT_EQ(a.segments[s].quads, b.segments[s].quads);
    EXPECT_EQ(a.segments[s].top, b.segments[s].top);
    EXPECT_EQ(a.segments[s].bottom, b.segments[s].bottom);
  }
}

TEST(PackedModel, MemoryIsUsedAgainWithoutATrace) {
  PackedModel again;
  for (int round = 0; round < 2; ++round) {
    for (const Model& model : models()) {
      pack(model.body, model.mesh, again);
      expect_equal(again, packed(model));
    }
  }
}

// Meshes that make_mesh() does not make, as far as pack() can detect them.
std::vector<Model> impossible_models() {
  std::vector<Model> wrong(4, make_model(Shape{}));
  const std::vector<SurfaceClass> strip = {SurfaceClass::arms};
  wrong[0].mesh.stacks[0] = {0, 12, strip};
  wrong[1].mesh.stacks[4] = {70, 1, std::vector<SurfaceClass>(71, SurfaceClass::arms)};
  wrong[2].mesh.stacks[7] = {7, 40, std::vector<SurfaceClass>(8, SurfaceClass::head)};
  wrong[3].mesh.stacks = {};
  return wrong;
}

TEST(PackedModel, RefusesWhatIsNoStackOfRings) {
  for (const Model& model : impossible_models()) {
    PackedModel out;
    testing_errors::message_of(ErrorKind::usage, [&] { pack(model.body, model.mesh, out); });
  }
}

TEST(PackedModelCache, FollowsAModelThatIsChangedInPlace) {
  PackedModelCache cache;
  Model model = make_model(Shape{});
  const auto check = [&] { expect_equal(cache.of(model.body, model.mesh), packed(model)); };
  check();
  Shape shape;
  shape[Segment::l_forearm].length = 1.1;
  model = make_model(shape);
  check();
  model = make_model(with_sleeve(0.3));
  check();
  // Sleeves to the shoulder and to the elbow: the same vertices, other classes.
  model = make_model(with_sleeve(0.0));
  check();
  const std::vector<Eigen::Vector3f> vertices = model.mesh.vertices;
  model = make_model(with_sleeve(1.0));
  ASSERT_EQ(model.mesh.vertices, vertices);
  check();
  model.body.clavicle_lift += 0.01;  // only the skeleton
  check();
  model.mesh.vertices.back().x() += 0.001F;  // only the surface
  check();
  model = make_model(Shape{});
  check();
}

TEST(PackedModelCache, PacksTheSameModelOnce) {
  PackedModelCache cache;
  const Model model = make_model(Shape{});
  cache.of(model.body, model.mesh);
  // Another object with the same content is the same model. A mark in the cache's memory would be gone if it
  // packed again.
  const Model same = make_model(Shape{});
  auto& inside = const_cast<PackedModel&>(cache.of(same.body, same.mesh));
  inside.x[0] = 1234.0F;
  EXPECT_EQ(cache.of(model.body, model.mesh).x[0], 1234.0F);
  EXPECT_EQ(cache.of(same.body, same.mesh).x[0], 1234.0F);
  const Model other = make_model(testing_poses::other_shape());
  expect_equal(cache.of(other.body, other.mesh), packed(other));
  expect_equal(cache.of(model.body, model.mesh), packed(model));
}

TEST(PackedModelCache, IsNotSpoiledByAModelThatItRefuses) {
  const Model good = make_model(Shape{});
  for (const Model& wrong : impossible_models()) {
    PackedModelCache cache;
    cache.of(good.body, good.mesh);
    EXPECT_THROW(cache.of(wrong.body, wrong.mesh), Error);
    EXPECT_THROW(cache.of(wrong.body, wrong.mesh), Error) << "once more";
    expect_equal(cache.of(good.body, good.mesh), packed(good));
  }
}

}  // namespace
}  // namespace telemime
