// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

constexpr std::array<Segment, 6> kArmSegments = {Segment::l_upper_arm, Segment::r_upper_arm,
                                                 Segment::l_forearm,   Segment::r_forearm,
                                                 Segment::l_hand,      Segment::r_hand};

BodyMesh mesh_of(const Shape& shape) {
  return make_mesh(make_body(shape));
}

Range triangles_of(const BodyMesh& mesh, Segment s) {
  return mesh.triangle_range[static_cast<std::size_t>(s)];
}

double area(const BodyMesh& mesh, const MeshTriangle& t) {
  const Eigen::Vector3d a = mesh.vertices[t.vertex[0]].cast<double>();
  const Eigen::Vector3d b = mesh.vertices[t.vertex[1]].cast<double>();
  const Eigen::Vector3d c = mesh.vertices[t.vertex[2]].cast<double>();
  return 0.5 * (b - a).cross(c - a).norm();
}

double area(const BodyMesh& mesh, Segment segment, SurfaceClass surface) {
  double sum = 0.0;
  for (auto t = triangles_of(mesh, segment).begin; t < triangles_of(mesh, segment).end; ++t) {
    sum += mesh.triangles[t].surface == surface ? area(mesh, mesh.triangles[t]) : 0.0;
  }
  return sum;
}

double area_of_arms(const BodyMesh& mesh, SurfaceClass surface) {
  double sum = 0.0;
  for (const Segment s : kArmSegments) {
    sum += area(mesh, s, surface);
  }
  return sum;
}

double volume(const BodyMesh& mesh, Segment segment) {
  double six = 0.0;
  for (auto t = triangles_of(mesh, segment).begin; t < triangles_of(mesh, segment).end; ++t) {
    const auto& v = mesh.triangles[t].vertex;
    six += mesh.vertices[v[0]].cast<double>().dot(
        mesh.vertices[v[1]].cast<double>().cross(mesh.vertices[v[2]].cast<double>()));
  }
  return six / 6.0;
}

// Ranges cover [0, count) without gap or overlap.
void expect_tiles(std::array<Range, kSegmentCount> ranges, std::size_t count) {
  std::sort(ranges.begin(), ranges.end(), [](Range a, Range b) { return a.begin < b.begin; });
  EXPECT_EQ(ranges.front().begin, 0U);
  EXPECT_EQ(ranges.back().end, count);
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    EXPECT_LT(ranges[s].begin, ranges[s].end);
    EXPECT_TRUE(s == 0 || ranges[s].begin == ranges[s - 1].end);
  }
}

TEST(Mesh, SegmentsAreContiguousAndKeepToThemselves) {
  for (const double sleeve : {0.0, 0.5, 1.3, 2.0}) {
    Shape shape = testing_poses::other_shape();
    shape.sleeve = sleeve;
    const BodyMesh mesh = mesh_of(shape);
    expect_tiles(mesh.vertex_range, mesh.vertices.size());
    expect_tiles(mesh.triangle_range, mesh.triangles.size());
    expect_tiles(mesh.edge_range, mesh.edges.size());
    for (std::size_t s = 0; s < kSegmentCount; ++s) {
      const auto inside = [](Range range, std::uint32_t i) { return i >= range.begin && i < range.end; };
      for (auto t = mesh.triangle_range[s].begin; t < mesh.triangle_range[s].end; ++t) {
        for (const auto v : mesh.triangles[t].vertex) {
          ASSERT_TRUE(inside(mesh.vertex_range[s], v));
        }
      }
      for (auto e = mesh.edge_range[s].begin; e < mesh.edge_range[s].end; ++e) {
        ASSERT_TRUE(inside(mesh.triangle_range[s], mesh.edges[e].triangle[0]));
        ASSERT_TRUE(inside(mesh.triangle_range[s], mesh.edges[e].triangle[1]));
      }
    }
  }
}

TEST(Mesh, IsClosedEveryEdgeHasItsTwoTriangles) {
  const BodyMesh mesh = mesh_of(testing_poses::other_shape());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> triangle_of;  // by directed edge
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t].vertex;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool once = triangle_of.emplace(std::pair(v[k], v[(k + 1) % 3]), t).second;
      ASSERT_TRUE(once) << "two triangles run along an edge in the same direction";
    }
  }
  ASSERT_EQ(triangle_of.size(), 2 * mesh.edges.size());
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  for (const MeshEdge& edge : mesh.edges) {
    const auto [a, b] = edge.vertex;
    ASSERT_TRUE(triangle_of.contains({a, b}) && triangle_of.contains({b, a}));
    const std::set<std::uint32_t> expected = {triangle_of.at({a, b}), triangle_of.at({b, a})};
    const std::set<std::uint32_t> found(edge.triangle.begin(), edge.triangle.end());
    EXPECT_EQ(found, expected);
    EXPECT_TRUE(seen.emplace(std::min(a, b), std::max(a, b)).second) << "listed twice";
  }
  // A sphere each: vertices - edges + triangles = 2.
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    const auto count = [](Range r) { return static_cast<int>(r.end - r.begin); };
    EXPECT_EQ(count(mesh.vertex_range[s]) - count(mesh.edge_range[s]) + count(mesh.triangle_range[s]), 2);
  }
}

TEST(Mesh, FacesOutwardWithHumanVolumes) {
  const BodyMesh mesh = mesh_of(Shape{});
  // Litres, loose: a wrong orientation is negative, a wrong unit a thousand times off.
  const std::pair<Segment, std::array<double, 2>> litres[] = {
      {Segment::chest, {15, 45}},       {Segment::head, {3, 7}},        {Segment::l_upper_arm, {1, 3.5}},
      {Segment::r_upper_arm, {1, 3.5}}, {Segment::l_forearm, {0.5, 2}}, {Segment::r_forearm, {0.5, 2}},
      {Segment::l_hand, {0.2, 0.8}},    {Segment::r_hand, {0.2, 0.8}}};
  for (const auto& [segment, range] : litres) {
    EXPECT_GT(1000 * volume(mesh, segment), range[0]) << kSegmentNames[static_cast<std::size_t>(segment)];
    EXPECT_LT(1000 * volume(mesh, segment), range[1]) << kSegmentNames[static_cast<std::size_t>(segment)];
  }
}

TEST(Mesh, NoTriangleIsEmpty) {
  const BodyMesh mesh = mesh_of(Shape{});
  for (const MeshTriangle& t : mesh.triangles) {
    EXPECT_GT(area(mesh, t), 1e-8);
  }
}

TEST(Mesh, ScalesAreSeenInTheVolume) {
  const BodyMesh average = mesh_of(Shape{});
  Shape shape;
  shape[Segment::r_forearm] = {1.1, 1.2, 1.3};
  shape[Segment::chest] = {1.05, 0.9, 1.1};
  const BodyMesh mesh = mesh_of(shape);
  EXPECT_NEAR(volume(mesh, Segment::r_forearm) / volume(average, Segment::r_forearm), 1.1 * 1.2 * 1.3, 1e-4);
  EXPECT_NEAR(volume(mesh, Segment::chest) / volume(average, Segment::chest), 1.05 * 0.9 * 1.1, 1e-4);
  EXPECT_NEAR(volume(mesh, Segment::l_forearm), volume(average, Segment::l_forearm), 1e-9);
  Shape tall;
  tall.stature *= 1.1;
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    const auto segment = static_cast<Segment>(s);
    EXPECT_NEAR(volume(mesh_of(tall), segment) / volume(average, segment), std::pow(1.1, 3), 1e-4);
  }
}

TEST(Mesh, LeftAndRightAreMirrorImages) {
  const BodyMesh mesh = mesh_of(testing_poses::other_shape());
  const std::pair<Segment, Segment> twins[] = {{Segment::chest, Segment::chest},
                                               {Segment::head, Segment::head},
                                               {Segment::l_upper_arm, Segment::r_upper_arm},
                                               {Segment::l_forearm, Segment::r_forearm},
                                               {Segment::l_hand, Segment::r_hand}};
  for (const auto& [one, other] : twins) {
    const Range here = mesh.vertex_range[static_cast<std::size_t>(one)];
    const Range there = mesh.vertex_range[static_cast<std::size_t>(other)];
    ASSERT_EQ(here.end - here.begin, there.end - there.begin);
    for (auto i = here.begin; i < here.end; ++i) {
      const Eigen::Vector3f image = mesh.vertices[i].cwiseProduct(Eigen::Vector3f(-1, 1, 1));
      const auto found = std::any_of(mesh.vertices.begin() + there.begin, mesh.vertices.begin() + there.end,
                                     [&](const Eigen::Vector3f& v) { return (v - image).norm() < 1e-6F; });
      ASSERT_TRUE(found) << kSegmentNames[static_cast<std::size_t>(one)];
    }
  }
}

TEST(Mesh, SleeveCoversTheArmFromTheShoulderDown) {
  Shape shape;
  double clothes = -1.0;
  double skin = 1e9;
  for (double sleeve = 0.0; sleeve <= 2.001; sleeve += 0.05) {
    shape.sleeve = sleeve;
    const BodyMesh mesh = mesh_of(shape);
    EXPECT_GE(area_of_arms(mesh, SurfaceClass::clothes), clothes) << sleeve;
    EXPECT_LE(area_of_arms(mesh, SurfaceClass::arms), skin) << sleeve;
    clothes = area_of_arms(mesh, SurfaceClass::clothes);
    skin = area_of_arms(mesh, SurfaceClass::arms);
  }
}

TEST(Mesh, SleeveEndsAtShoulderElbowAndWrist) {
  const auto with_sleeve = [](double sleeve) {
    Shape shape;
    shape.sleeve = sleeve;
    return mesh_of(shape);
  };
  const auto bare = [&](double sleeve, Segment segment) {
    return area(with_sleeve(sleeve), segment, SurfaceClass::arms);
  };
  const auto dressed = [&](double sleeve, Segment segment) {
    return area(with_sleeve(sleeve), segment, SurfaceClass::clothes);
  };
  for (const Segment upper : {Segment::l_upper_arm, Segment::r_upper_arm}) {
    EXPECT_EQ(dressed(0.0, upper), 0.0);
    EXPECT_GT(bare(0.5, upper), 0.0);
    EXPECT_GT(dressed(0.5, upper), 0.0);
    EXPECT_EQ(bare(1.0, upper), 0.0);
  }
  for (const Segment fore : {Segment::l_forearm, Segment::r_forearm}) {
    EXPECT_EQ(dressed(1.0, fore), 0.0);
    EXPECT_GT(bare(1.5, fore), 0.0);
    EXPECT_GT(dressed(1.5, fore), 0.0);
    EXPECT_EQ(bare(2.0, fore), 0.0);
  }
  for (const double sleeve : {0.0, 0.5, 2.0}) {
    EXPECT_EQ(dressed(sleeve, Segment::l_hand), 0.0) << "hands are never covered";
    EXPECT_EQ(bare(sleeve, Segment::chest), 0.0);
  }
  Shape shape;
  EXPECT_GT(area(mesh_of(shape), Segment::head, SurfaceClass::head), 0.0);
  EXPECT_EQ(area(mesh_of(shape), Segment::head, SurfaceClass::clothes), 0.0);
}

TEST(Mesh, SleeveDoesNotChangeTheForm) {
  Shape half;
  half.sleeve = 0.5;
  Shape full;
  full.sleeve = 1.0;
  const BodyMesh a = mesh_of(half);
  const BodyMesh b = mesh_of(full);
  for (const Segment s : kArmSegments) {
    EXPECT_NEAR(volume(a, s) / volume(b, s), 1.0, 0.005);
  }
}

}  // namespace
}  // namespace telemime
