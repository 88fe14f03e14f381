// SPDX-License-Identifier: Apache-2.0
#include "telemime/render/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "telemime/body/arm_ik.h"
#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

using testing_poses::kDegree;
using testing_poses::random_pose;

constexpr std::uint8_t kHead = static_cast<std::uint8_t>(SurfaceClass::head);
constexpr std::uint8_t kArms = static_cast<std::uint8_t>(SurfaceClass::arms);
constexpr std::uint8_t kClothes = static_cast<std::uint8_t>(SurfaceClass::clothes);

Camera small_camera(int width = 160, int height = 120) {
  return camera_from_field_of_view(width, height, 60.0);
}

// A mesh with only this segment; the others are empty.
struct Scene {
  BodyMesh mesh;
  Kinematics kinematics;
};

void add_triangle(BodyMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, SurfaceClass surface) {
  mesh.triangles.push_back({{a, b, c}, surface});
}

// An upright square plate at depth z (m), corners at +-half, seen from its front.
void add_plate(Scene& scene, Segment segment, double half, double z, double x, SurfaceClass surface) {
  BodyMesh& mesh = scene.mesh;
  const auto s = static_cast<std::size_t>(segment);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto h = static_cast<float>(half);
  mesh.vertices.insert(mesh.vertices.end(), {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}});
  // The camera's y points down and it looks along +z: counter-clockwise as it sees it is a, d, c, b.
  add_triangle(mesh, first, first + 3, first + 2, surface);
  add_triangle(mesh, first, first + 2, first + 1, surface);
  mesh.vertex_range[s] = {first, first + 4};
  scene.kinematics.camera_from_segment[s] = Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, z));
}

// A ball of latitude rings about the segment's origin.
Scene ball(double radius, const Eigen::Vector3d& centre, int sides) {
  Scene scene;
  BodyMesh& mesh = scene.mesh;
  const int rings = sides / 2;
  for (int r = 0; r <= rings; ++r) {
    for (int k = 0; k < sides; ++k) {
      const double polar = std::numbers::pi * r / rings;
      const double around = 2 * std::numbers::pi * k / sides;
      mesh.vertices.emplace_back(Eigen::Vector3d(radius * std::sin(polar) * std::cos(around),
                                                 radius * std::cos(polar),
                                                 radius * std::sin(polar) * std::sin(around))
                                     .cast<float>());
    }
  }
  for (int r = 0; r < rings; ++r) {
    for (int k = 0; k < sides; ++k) {
      const auto at = [&](int ring, int j) { return static_cast<std::uint32_t>(ring * sides + j % sides); };
      add_triangle(mesh, at(r, k), at(r, k + 1), at(r + 1, k), SurfaceClass::head);
      add_triangle(mesh, at(r, k + 1), at(r + 1, k + 1), at(r + 1, k), SurfaceClass::head);
    }
  }
  mesh.vertex_range[0] = {0, static_cast<std::uint32_t>(mesh.vertices.size())};
  scene.kinematics.camera_from_segment[0] = Eigen::Isometry3d(Eigen::Translation3d(centre));
  return scene;
}

// The planes may be longer than the image.
std::ptrdiff_t pixels_of(const Rendering& r) {
  return static_cast<std::ptrdiff_t>(r.width) * r.height;
}

std::ptrdiff_t count(const Rendering& r, std::uint8_t surface) {
  return std::count(r.surface.begin(), r.surface.begin() + pixels_of(r), surface);
}

std::uint8_t at(const Rendering& r, int x, int y) {
  return r
      .surface[static_cast<std::size_t>(y) * static_cast<std::size_t>(r.width) + static_cast<std::size_t>(x)];
}

Rendering render_body(const Body& body, const Pose& pose, const Camera& camera) {
  Rendering out;
  render(make_mesh(body), forward_kinematics(body, pose), camera, out);
  return out;
}

Pose seen_pose(double z = 1.5) {
  Pose pose;
  pose.root = {0.0, 0.35, z};
  return pose;
}

TEST(Renderer, PlateCoversThePixelsWhoseCentresItCovers) {
  Camera camera;
  camera.width = 40;
  camera.height = 30;
  camera.fx = camera.fy = 40.0;
  camera.cx = 19.5;
  camera.cy = 14.5;
  Scene scene;
  add_plate(scene, Segment::chest, 0.25, 2.0, 0.0, SurfaceClass::arms);  // 5 px each way
  Rendering out;
  render(scene.mesh, scene.kinematics, camera, out);
  // Centres 15 ... 24 and 10 ... 19.
  EXPECT_EQ(count(out, kArms), 100);
  EXPECT_EQ(at(out, 15, 10), kArms);
  EXPECT_EQ(at(out, 24, 19), kArms);
  EXPECT_EQ(at(out, 14, 15), 0);
  EXPECT_EQ(at(out, 25, 15), 0);
  EXPECT_EQ((std::array{out.left, out.right, out.top, out.bottom}), (std::array{15, 25, 10, 20}));
  for (std::size_t i = 0; i < static_cast<std::size_t>(pixels_of(out)); ++i) {
    ASSERT_NEAR(out.inverse_depth[i], out.surface[i] == 0 ? 0.0 : 0.5, 1e-6);
  }
}

TEST(Renderer, BallHasTheAreaOfItsOutline) {
  const Camera camera = small_camera(640, 480);
  const double radius = 0.3;
  const double z = 2.0;
  Rendering out;
  const Scene scene = ball(radius, {0, 0, z}, 96);
  render(scene.mesh, scene.kinematics, camera, out);
  const double outline = camera.fx * radius / std::sqrt(z * z - radius * radius);
  EXPECT_NEAR(static_cast<double>(count(out, kHead)), std::numbers::pi * outline * outline,
              0.005 * std::numbers::pi * outline * outline);
  EXPECT_NEAR(out.inverse_depth[240 * 640 + 320], 1.0 / (z - radius), 1e-3);
}

// Slow reference: the nearest of all front faces that cover the centre of the pixel.
TEST(Renderer, AgreesWithTheDefinition) {
  const Body body = make_body(testing_poses::other_shape());
  const BodyMesh mesh = make_mesh(body);
  const Camera camera = small_camera(80, 60);
  Random random(7);
  int seen = 0;
  int different = 0;
  for (int i = 0; i < 10; ++i) {
    Rendering out;
    render(mesh, forward_kinematics(body, random_pose(anatomical_limits(), random, 0.4)), camera, out);
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 80; ++x) {
        std::uint8_t surface = 0;
        double nearest = 0.0;
        for (const MeshTriangle& t : mesh.triangles) {
          std::array<Eigen::Vector3d, 3> v;
          for (std::size_t k = 0; k < 3; ++k) {
            v[k] = out.projected[t.vertex[k]].cast<double>() - Eigen::Vector3d(x, y, 0);
          }
          const auto cross = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
            return a.x() * b.y() - a.y() * b.x();
          };
          const double a = cross(v[1], v[2]);
          const double b = cross(v[2], v[0]);
          const double c = cross(v[0], v[1]);
          if (a <= 0 && b <= 0 && c <= 0 && a + b + c < 0) {
            const double w = (a * v[0].z() + b * v[1].z() + c * v[2].z()) / (a + b + c);
            surface = w > nearest ? static_cast<std::uint8_t>(t.surface) : surface;
            nearest = std::max(nearest, w);
          }
        }
        seen += surface != 0 ? 1 : 0;
        const float depth = out.inverse_depth[static_cast<std::size_t>(y) * 80 + static_cast<std::size_t>(x)];
        different += surface != at(out, x, y) || std::abs(depth - nearest) > 1e-4 ? 1 : 0;
      }
    }
  }
  ASSERT_GT(seen, 5000);
  EXPECT_LE(different, seen / 1000) << "of " << seen;
}

TEST(Renderer, NearerSurfaceWinsInEitherOrder) {
  const Camera camera = small_camera();
  for (const bool near_first : {true, false}) {
    Scene scene;
    const Segment first = Segment::chest;
    const Segment second = Segment::head;
    add_plate(scene, first, 0.2, near_first ? 1.0 : 1.4, 0.0,
              near_first ? SurfaceClass::arms : SurfaceClass::clothes);
    add_plate(scene, second, 0.2, near_first ? 1.4 : 1.0, near_first ? 0.25 : 0.0,
              near_first ? SurfaceClass::clothes : SurfaceClass::arms);
    if (!near_first) {
      scene.kinematics.camera_from_segment[0].translation().x() = 0.25;
    }
    Rendering out;
    render(scene.mesh, scene.kinematics, camera, out);
    EXPECT_EQ(at(out, 80, 60), kArms);
    const double half = camera.fx * 0.2;
    EXPECT_NEAR(static_cast<double>(count(out, kArms)), 4 * half * half, 4 * half);
    EXPECT_GT(count(out, kClothes), 100) << "the far plate looks out at the side";
  }
}

TEST(Renderer, BackOfASurfaceIsNotSeen) {
  Scene scene;
  add_plate(scene, Segment::chest, 0.2, 1.0, 0.0, SurfaceClass::arms);
  scene.kinematics.camera_from_segment[0].linear() = Eigen::Vector3d(-1, 1, -1).asDiagonal();
  Rendering out;
  render(scene.mesh, scene.kinematics, small_camera(), out);
  EXPECT_EQ(count(out, 0), pixels_of(out));
}

TEST(Renderer, BodyOutOfSightLeavesThePlanesEmpty) {
  const Body body = make_body(Shape{});
  const Eigen::Vector3d places[] = {{0, 0.3, -2.0}, {30, 0.3, 1.5}, {-30, 0, 2},  {0, 40, 1.5},
                                    {0, -40, 1.5},  {0, 0, -0.5},   {1e7, 0, 1.5}};
  for (const Eigen::Vector3d& place : places) {
    Pose pose;
    pose.root = place;
    Rendering out;
    const BodyMesh mesh = make_mesh(body);
    render(mesh, forward_kinematics(body, pose), small_camera(), out);
    EXPECT_EQ(count(out, 0), pixels_of(out)) << place.transpose();
    std::vector<Eigen::Vector2f> contour = {{1, 1}};
    occluding_contour(mesh, out, contour);
    EXPECT_TRUE(contour.empty()) << place.transpose();
  }
}

TEST(Renderer, BodyAtTheBorderIsCutAndStaysInThePlanes) {
  const Body body = make_body(Shape{});
  const BodyMesh mesh = make_mesh(body);
  const Eigen::Vector3d places[] = {{-0.9, 0.35, 1.5}, {0.9, 0.35, 1.5}, {0, 1.0, 1.5},  {0, -0.4, 1.5},
                                    {0, 0.2, 0.4},     {0, 0.2, 0.1},    {0.05, 0.3, 0}, {0, 0.4, 0.05}};
  Rendering out;
  for (const Eigen::Vector3d& place : places) {
    Pose pose;
    pose.root = place;
    render(mesh, forward_kinematics(body, pose), small_camera(), out);
    // Around the camera everything may be too near.
    EXPECT_TRUE(place.z() < 0.2 || count(out, 0) < pixels_of(out)) << place.transpose();
    EXPECT_GE(out.left, 0);
    EXPECT_GE(out.top, 0);
    EXPECT_LE(out.right, 160);
    EXPECT_LE(out.bottom, 120);
    std::vector<Eigen::Vector2f> contour;
    occluding_contour(mesh, out, contour);
    for (const Eigen::Vector2f& p : contour) {
      ASSERT_TRUE(std::lround(p.x()) >= 0 && std::lround(p.x()) < 160 && std::lround(p.y()) >= 0 &&
                  std::lround(p.y()) < 120);
    }
  }
}

TEST(Renderer, WhatWasThereBeforeIsCleared) {
  const Body body = make_body(Shape{});
  const BodyMesh mesh = make_mesh(body);
  Random random(1);
  Rendering reused;
  for (int i = 0; i < 60; ++i) {
    Pose pose = random_pose(anatomical_limits(), random);
    pose.root.x() += random.uniform(-0.7, 0.7);
    const Camera camera = i % 17 == 16 ? small_camera(80, 60) : small_camera();
    render(mesh, forward_kinematics(body, pose), camera, reused);
    Rendering fresh;
    render(mesh, forward_kinematics(body, pose), camera, fresh);
    ASSERT_EQ(reused.surface, fresh.surface) << i;
    ASSERT_EQ(reused.inverse_depth, fresh.inverse_depth) << i;
    for (std::size_t p = 0; p < static_cast<std::size_t>(pixels_of(fresh)); ++p) {
      const int x = static_cast<int>(p) % fresh.width;
      const int y = static_cast<int>(p) / fresh.width;
      const bool inside = x >= fresh.left && x < fresh.right && y >= fresh.top && y < fresh.bottom;
      ASSERT_TRUE(inside || fresh.surface[p] == 0) << "outside of the rectangle";
      ASSERT_EQ(fresh.surface[p] == 0, fresh.inverse_depth[p] == 0.0F);
    }
  }
}

TEST(Renderer, OddSizesWork) {
  const Body body = make_body(Shape{});
  for (const auto& [width, height] : {std::pair(1, 1), {7, 5}, {161, 119}, {1, 40}, {40, 1}}) {
    Camera camera = small_camera().scaled_to(width, height);
    Pose pose = seen_pose();
    pose.root = {0.0, 0.2, 1.2};  // the chest is in the middle
    const Rendering out = render_body(body, pose, camera);
    ASSERT_GE(out.surface.size(), static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    EXPECT_EQ(at(out, width / 2, height / 2), kClothes) << width << "x" << height;
  }
}

TEST(Renderer, SharesOfTheImageDoNotDependOnItsSize) {
  const Body body = make_body(Shape{});
  const auto share = [&](int width, int height, std::uint8_t surface) {
    const Rendering out = render_body(body, seen_pose(), small_camera().scaled_to(width, height));
    return static_cast<double>(count(out, surface)) / (width * height);
  };
  for (const std::uint8_t surface : {kHead, kArms, kClothes}) {
    EXPECT_GT(share(640, 480, surface), 0.005);
    EXPECT_NEAR(share(161, 119, surface) / share(640, 480, surface), 1.0, 0.05);
  }
}

TEST(Renderer, MovingThePrincipalPointMovesThePicture) {
  const Body body = make_body(Shape{});
  Random random(2);
  const Pose pose = random_pose(anatomical_limits(), random, 0.2);
  const Camera camera = small_camera();
  Camera shifted = camera;
  shifted.cx += 8;  // powers of two add no rounding error
  shifted.cy -= 4;
  const Rendering a = render_body(body, pose, camera);
  const Rendering b = render_body(body, pose, shifted);
  int different = 0;
  for (int y = 4; y < 120; ++y) {
    for (int x = 0; x < 152; ++x) {
      different += at(a, x, y) != at(b, x + 8, y - 4) ? 1 : 0;
    }
  }
  EXPECT_LE(different, 3);
  EXPECT_NE(a.surface, b.surface);
}

TEST(Renderer, ShiftOfBodyAndPrincipalPointCancels) {
  Camera camera = small_camera();
  Scene scene;
  add_plate(scene, Segment::chest, 0.25, 2.0, 0.0, SurfaceClass::arms);
  Rendering before;
  render(scene.mesh, scene.kinematics, camera, before);
  scene.kinematics.camera_from_segment[0].translation().x() += 0.25;
  camera.cx -= camera.fx * 0.25 / 2.0;
  Rendering after;
  render(scene.mesh, scene.kinematics, camera, after);
  EXPECT_EQ(before.surface, after.surface);
  EXPECT_GT(count(before, kArms), 100);
}

TEST(Renderer, MirroredPoseGivesTheMirrorImage) {
  const Body body = make_body(testing_poses::other_shape());
  const Camera camera = small_camera();
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Pose pose = random_pose(anatomical_limits(), random, 0.3);
    const Rendering here = render_body(body, pose, camera);
    const Rendering there = render_body(body, mirrored(pose), camera);
    int seen = 0;
    int different = 0;
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        seen += at(here, x, y) != 0 ? 1 : 0;
        different += at(here, x, y) != at(there, 159 - x, y) ? 1 : 0;
      }
    }
    ASSERT_GT(seen, 500);
    // Quadrilaterals are not divided into triangles symmetrically.
    ASSERT_LE(different, seen / 50) << i;
  }
}

}  // namespace
}  // namespace telemime
