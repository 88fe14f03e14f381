// SPDX-License-Identifier: Apache-2.0
#include "avatars/surface.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <utility>

namespace telemime {
namespace {

using Eigen::Vector3d;

double area_of(const Triangles& surface) {
  double area = 0.0;
  for (const auto& t : surface.triangles) {
    const Vector3d& a = surface.vertices[t[0]];
    area += 0.5 * (surface.vertices[t[1]] - a).cross(surface.vertices[t[2]] - a).norm();
  }
  return area;
}

/// By the divergence theorem: positive where triangles look outward.
double volume_of(const Triangles& surface) {
  double volume = 0.0;
  for (const auto& t : surface.triangles) {
    volume += surface.vertices[t[0]].dot(surface.vertices[t[1]].cross(surface.vertices[t[2]])) / 6.0;
  }
  return volume;
}

void expect_closed(const Triangles& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++edges[{t[k], t[(k + 1) % 3]}];
    }
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, edges.contains({edge.second, edge.first}) ? edges.at({edge.second, edge.first}) : 0);
  }
}

const Eigen::AlignedBox3d kBox(Vector3d(-0.3, -0.3, -0.3), Vector3d(0.3, 0.3, 0.3));

TEST(Triangles, ABallIsRound) {
  const Vector3d centre(0.02, -0.01, 0.03);
  const Triangles ball = surface_of(round_cone(centre, centre + Vector3d(1e-9, 0, 0), 0.2, 0.2), kBox, 0.015);
  ASSERT_GT(ball.vertices.size(), 500U);
  for (std::size_t i = 0; i < ball.vertices.size(); ++i) {
    const Vector3d out = ball.vertices[i] - centre;
    EXPECT_NEAR(out.norm(), 0.2, 1e-4);
    EXPECT_GT(out.normalized().dot(ball.normals[i]), 0.9999);
  }
  expect_closed(ball);
  EXPECT_NEAR(area_of(ball), 4.0 * std::numbers::pi * 0.04, 0.003);
  EXPECT_NEAR(volume_of(ball), 4.0 / 3.0 * std::numbers::pi * 0.008, 0.0003);
}

TEST(Triangles, ALoftHasTheRadiiOfItsRings) {
  const Field solid = loft(Vector3d::Zero(), Vector3d::UnitY(), Vector3d::UnitZ(),
                           {{-0.2, 0.0, 0.10, 0.05}, {0.0, 0.02, 0.08, 0.06}, {0.2, 0.0, 0.05, 0.05}});
  EXPECT_NEAR(solid({0.08, 0.0, 0.02}), 0.0, 1e-9);
  EXPECT_NEAR(solid({0.0, 0.0, 0.08}), 0.0, 1e-9);
  EXPECT_NEAR(solid({0.0, 0.23, 0.0}), 0.03, 1e-9);  // flat ends
  EXPECT_LT(solid({0.0, 0.1, 0.0}), 0.0);
  // The ellipse of the middle ring, not the straight line between its neighbours.
  EXPECT_GT(solid({0.0, 0.0, -0.05}), 0.005);
}

TEST(Triangles, FieldsCombineAsSolidsDo) {
  const Field left = ellipsoid({-0.05, 0, 0}, {0.1, 0.1, 0.1});
  const Field right = ellipsoid({0.05, 0, 0}, {0.1, 0.1, 0.1});
  const Vector3d only_left(-0.12, 0, 0);
  const Vector3d both(0, 0, 0);
  const Vector3d beside(0.0, 0.11, 0.0);
  EXPECT_LT(blended({left, right}, 0.01)(only_left), 0.0);
  EXPECT_GT(overlap(left, right, 0.01)(only_left), 0.0);
  EXPECT_LT(overlap(left, right, 0.01)(both), 0.0);
  EXPECT_LT(without(left, right, 0.01)(only_left), 0.0);
  EXPECT_GT(without(left, right, 0.01)(both), 0.0);
  EXPECT_GT(blended({left, right}, 0.01)(beside), 0.0);
  EXPECT_LT(blended({left, right}, 0.15)(beside), 0.0);  // the notch between them is filled
  EXPECT_LT(grown(left, 0.02)({-0.05, 0.115, 0}), 0.0);
  EXPECT_NEAR(mirror_x(right)({-0.1, 0.02, 0}), right({0.1, 0.02, 0}), 1e-12);
  const Field ring = seam(left, half_space({-0.05, 0, 0}, Vector3d::UnitX()), 0.01);
  EXPECT_LT(ring({-0.05, 0.1, 0.0}), 0.0);
  EXPECT_GT(ring({-0.05, 0.0, 0.0}), 0.0);
}

TEST(Triangles, AMirrorImageLooksOutward) {
  const Triangles ball = surface_of(ellipsoid({0.1, 0, 0}, {0.1, 0.05, 0.05}), kBox, 0.02);
  Triangles pair = mirrored_x(ball);
  EXPECT_NEAR(volume_of(pair), volume_of(ball), 1e-12);
  append(pair, ball);
  expect_closed(pair);
  EXPECT_NEAR(volume_of(pair), 2.0 * volume_of(ball), 1e-12);
}

}  // namespace
}  // namespace telemime
