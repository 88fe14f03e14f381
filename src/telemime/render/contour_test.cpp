// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "telemime/body/arm_ik.h"
#include "telemime/body/testing_poses.h"
#include "telemime/render/renderer.h"

namespace telemime {
namespace {

using testing_poses::kDegree;
using testing_poses::random_pose;

struct Seen {
  Rendering rendering;
  std::vector<Eigen::Vector2f> contour;
};

Seen see(const Body& body, const Pose& pose, const Camera& camera) {
  Seen seen;
  const BodyMesh mesh = make_mesh(body);
  render(mesh, forward_kinematics(body, pose), camera, seen.rendering);
  occluding_contour(mesh, seen.rendering, seen.contour);
  return seen;
}

// The largest step of depth (m) between neighbours within `reach` pixels; 99 where the body ends.
double depth_step_near(const Rendering& r, int x, int y, int reach) {
  float low = 1e9F;
  float high = 0.0F;
  for (int v = std::max(0, y - reach); v <= std::min(r.height - 1, y + reach); ++v) {
    for (int u = std::max(0, x - reach); u <= std::min(r.width - 1, x + reach); ++u) {
      const float w = r.inverse_depth[static_cast<std::size_t>(v) * static_cast<std::size_t>(r.width) +
                                      static_cast<std::size_t>(u)];
      if (w == 0.0F) {
        return 99.0;
      }
      low = std::min(low, 1.0F / w);
      high = std::max(high, 1.0F / w);
    }
  }
  return high - low;
}

TEST(Contour, LiesWhereTheBodyEndsOrTheDepthJumps) {
  const Body body = make_body(Shape{});
  const Camera camera = camera_from_field_of_view(320, 240, 60.0);
  Random random(1);
  std::size_t points = 0;
  std::size_t astray = 0;
  for (int i = 0; i < 20; ++i) {
    const Seen seen = see(body, random_pose(anatomical_limits(), random, 0.2), camera);
    for (const Eigen::Vector2f& p : seen.contour) {
      const int x = static_cast<int>(std::lround(p.x()));
      const int y = static_cast<int>(std::lround(p.y()));
      ++points;
      astray += depth_step_near(seen.rendering, x, y, 2) < 0.01 ? 1 : 0;
    }
  }
  ASSERT_GT(points, 5000U);
  EXPECT_LT(static_cast<double>(astray) / static_cast<double>(points), 0.02);
}

TEST(Contour, RunsAlongTheWholeOutline) {
  const Body body = make_body(Shape{});
  const Camera camera = camera_from_field_of_view(320, 240, 60.0);
  Pose pose;
  pose.root = {0.0, 0.35, 1.6};
  pose[Angle::l_shoulder_abduct] = 40 * kDegree;
  pose[Angle::r_shoulder_abduct] = -40 * kDegree;
  const Seen seen = see(body, pose, camera);
  const Rendering& r = seen.rendering;
  const auto covered = [&](int x, int y) {
    return r.surface[static_cast<std::size_t>(y) * static_cast<std::size_t>(r.width) +
                     static_cast<std::size_t>(x)] != 0;
  };
  int outline = 0;
  int missed = 0;
  for (int y = 1; y < r.height - 1; ++y) {
    for (int x = 1; x < r.width - 1; ++x) {
      if (!covered(x, y) ||
          (covered(x - 1, y) && covered(x + 1, y) && covered(x, y - 1) && covered(x, y + 1))) {
        continue;
      }
      ++outline;
      const bool near = std::any_of(seen.contour.begin(), seen.contour.end(), [&](const Eigen::Vector2f& p) {
        return (p - Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y))).norm() < 2.0F;
      });
      missed += near ? 0 : 1;
    }
  }
  ASSERT_GT(outline, 500);
  EXPECT_LT(missed, outline / 50);
}

TEST(Contour, HasAboutOnePointAPixel) {
  const Body body = make_body(Shape{});
  Pose pose;
  pose.root = {0.0, 0.35, 1.6};
  const auto points = [&](int width) {
    return static_cast<double>(
        see(body, pose, camera_from_field_of_view(width, width * 3 / 4, 60.0)).contour.size());
  };
  EXPECT_GT(points(160), 200.0);
  EXPECT_NEAR(points(640) / points(160), 4.0, 0.8);  // edges shorter than half a pixel also give one
}

// The right forearm in front of the belly or behind the back, at the same place of the image.
Pose forearm_across(const Body& body, double depth) {
  Pose pose;
  pose.root = {0.0, 0.35, 1.6};
  const Eigen::Vector3d wrist = pose.root + Eigen::Vector3d(0.0, -0.25, -depth);
  const auto arm = solve_arm(body, pose, Side::right, {wrist, 0.3}, anatomical_limits());
  if (arm) {
    set_arm_angles(pose, Side::right, *arm);
  }
  return pose;
}

std::size_t points_near(const Seen& seen, const Eigen::Vector2d& pixel, double reach) {
  return static_cast<std::size_t>(
      std::count_if(seen.contour.begin(), seen.contour.end(),
                    [&](const Eigen::Vector2f& p) { return (p.cast<double>() - pixel).norm() < reach; }));
}

TEST(Contour, OfAnArmBehindTheTrunkIsHidden) {
  const Body body = make_body(Shape{});
  const Camera camera = camera_from_field_of_view(320, 240, 60.0);
  const Pose front = forearm_across(body, 0.25);
  const Pose behind = forearm_across(body, -0.22);
  const auto wrist = [&](const Pose& pose) { return forward_kinematics(body, pose).joints[Joint::r_wrist]; };
  ASSERT_LT(wrist(front).z(), 1.4);
  ASSERT_GT(wrist(behind).z(), 1.75);
  EXPECT_GT(points_near(see(body, front, camera), camera.project(wrist(front)), 12), 20U);
  EXPECT_EQ(points_near(see(body, behind, camera), camera.project(wrist(behind)), 12), 0U);
}

TEST(Contour, IsClearedFirst) {
  const Body body = make_body(Shape{});
  const BodyMesh mesh = make_mesh(body);
  Pose pose;
  pose.root = {0.0, 0.35, 1.6};
  const Camera camera = camera_from_field_of_view(160, 120, 60.0);
  Rendering rendering;
  render(mesh, forward_kinematics(body, pose), camera, rendering);
  std::vector<Eigen::Vector2f> once;
  std::vector<Eigen::Vector2f> twice(17);
  occluding_contour(mesh, rendering, once);
  occluding_contour(mesh, rendering, twice);
  EXPECT_EQ(once, twice);
}

}  // namespace
}  // namespace telemime
