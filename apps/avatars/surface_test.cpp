// SPDX-License-Identifier: Apache-2.0
#include "avatars/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "avatars/figure.h"
#include "telemime/body/body.h"

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

const Figure& figure() {
  static const Figure person = make_figure(make_body(Shape{}));
  return person;
}

TEST(Simplify, ABallStaysABallOfFewerTriangles) {
  // In the head: one bone moves it as a whole.
  const Vector3d middle = figure().at(HumanBone::head) + Vector3d(0.0, 0.12, 0.0);
  constexpr double kRadius = 0.05;
  const Field ball = ellipsoid(middle, Vector3d::Constant(kRadius));
  const Eigen::AlignedBox3d box(middle - Vector3d::Constant(0.08), middle + Vector3d::Constant(0.08));
  const Triangles fine = surface_of(ball, box, 0.004);
  Triangles coarse = fine;
  simplify(figure(), 0.0008, coarse);
  expect_closed(coarse);
  EXPECT_LT(4 * coarse.triangles.size(), fine.triangles.size());
  EXPECT_GT(coarse.triangles.size(), 100U);
  EXPECT_EQ(coarse.vertices.size(), coarse.normals.size());
  const double true_volume = 4.0 / 3.0 * std::numbers::pi * std::pow(kRadius, 3);
  EXPECT_NEAR(volume_of(coarse) / true_volume, 1.0, 3.0 * 0.0008 / kRadius);
  for (std::size_t v = 0; v < coarse.vertices.size(); ++v) {
    EXPECT_NEAR((coarse.vertices[v] - middle).norm(), kRadius, 1e-3);
    EXPECT_GT(coarse.normals[v].dot((coarse.vertices[v] - middle).normalized()), 0.99);
    EXPECT_NE(std::find(fine.vertices.begin(), fine.vertices.end(), coarse.vertices[v]), fine.vertices.end());
  }
}

TEST(Simplify, WhatBendsKeepsItsVertices) {
  // A tube about the left arm: straight, so that without bending nearly nothing of it would be left.
  const Vector3d shoulder = figure().at(HumanBone::l_upper_arm);
  const Vector3d elbow = figure().at(HumanBone::l_lower_arm);
  const Vector3d wrist = figure().at(HumanBone::l_hand);
  const Eigen::AlignedBox3d box(shoulder - Vector3d(0.06, 0.08, 0.08), wrist + Vector3d(0.06, 0.08, 0.08));
  Triangles tube = surface_of(round_cone(shoulder, wrist, 0.035, 0.035), box, 0.006);
  simplify(figure(), 0.0006, tube);
  expect_closed(tube);
  const auto within = [&](double x) {
    return std::count_if(tube.vertices.begin(), tube.vertices.end(),
                         [&](const Vector3d& v) { return std::abs(v.x() - x) < 0.035; });
  };
  const auto at_elbow = within(elbow.x());
  EXPECT_GT(at_elbow, 30);
  EXPECT_GT(at_elbow, 2 * within(0.45 * elbow.x() + 0.55 * wrist.x()));
}

TEST(Simplify, NothingStaysNothing) {
  Triangles none;
  simplify(figure(), 0.001, none);
  EXPECT_TRUE(none.triangles.empty());
}

}  // namespace
}  // namespace telemime
