// SPDX-License-Identifier: Apache-2.0
#include "avatars/simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "telemime/body/body.h"

namespace telemime {
namespace {

using Eigen::Vector3d;

double volume(const Triangles& t) {
  double sum = 0.0;
  for (const auto& [a, b, c] : t.triangles) {
    sum += t.vertices[a].dot(t.vertices[b].cross(t.vertices[c])) / 6.0;
  }
  return sum;
}

void expect_closed(const Triangles& t) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& [a, b, c] : t.triangles) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      ++edges[{from, to}];
    }
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U);
  }
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
  EXPECT_NEAR(volume(coarse) / true_volume, 1.0, 3.0 * 0.0008 / kRadius);
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
