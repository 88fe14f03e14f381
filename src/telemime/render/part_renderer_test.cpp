// SPDX-License-Identifier: Apache-2.0
#include "telemime/render/part_renderer.h"

#include <gtest/gtest.h>

#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

using testing_poses::random_pose;

void expect_same(const Rendering& a, const Rendering& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  const auto pixels = static_cast<std::ptrdiff_t>(a.width) * a.height;
  ASSERT_TRUE(std::equal(a.surface.begin(), a.surface.begin() + pixels, b.surface.begin()));
  ASSERT_TRUE(std::equal(a.inverse_depth.begin(), a.inverse_depth.begin() + pixels, b.inverse_depth.begin()));
  ASSERT_EQ(a.facing, b.facing);
  ASSERT_EQ(a.projected, b.projected);
}

// In the picture, half outside, wholly outside, and with parts nearer than the nearest that is drawn.
const Eigen::Vector3d kRoots[] = {{0, 0.35, 1.5}, {0.7, 0.2, 1.2}, {30, 0, 1.5}, {0, 0.2, 0.25}};

TEST(PartRenderer, SegmentsOverTheOthersAreTheWhole) {
  const Body body = make_body(Shape{});
  const BodyMesh mesh = make_mesh(body);
  const Camera camera = camera_from_field_of_view(160, 120, 60.0);
  Random random(1);
  Rendering whole;
  Rendering base;
  Rendering over;
  for (int i = 0; i < 40; ++i) {
    for (const Eigen::Vector3d& root : kRoots) {
      Pose pose = random_pose(anatomical_limits(), random);
      pose.root = root;
      const Kinematics k = forward_kinematics(body, pose);
      render(mesh, k, camera, whole);
      for (const unsigned long long which : {0x00ULL, 0x07ULL, 0xA5ULL, 0xFFULL}) {
        const SegmentSet later(which);
        render_segments(~later, mesh, k, camera, base);
        render_over(base, later, mesh, k, camera, over);
        expect_same(whole, over);
      }
    }
  }
}

TEST(PartRenderer, ForgetsNothingThatMoved) {
  const Body body = make_body(Shape{});
  const BodyMesh mesh = make_mesh(body);
  const Camera camera = camera_from_field_of_view(160, 120, 60.0);
  Random random(2);
  Rendering whole;
  PartRenderer parts;
  Pose pose;
  for (const Eigen::Vector3d& root : kRoots) {
    pose.root = root;
    for (int i = 0; i < 60; ++i) {
      // Left arm, right arm, or nothing, many times over; then another place.
      const Pose other = random_pose(anatomical_limits(), random);
      const Angle first = i % 3 == 0 ? Angle::l_shoulder_flexion : Angle::r_shoulder_flexion;
      if (i % 7 != 0) {
        pose[first] = other[first];
      }
      const Kinematics k = forward_kinematics(body, pose);
      render(mesh, k, camera, whole);
      expect_same(whole, parts.render(mesh, k, camera));
    }
  }
}

}  // namespace
}  // namespace telemime
