// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/camera.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

TEST(Camera, RayInvertsProjection) {
  const Camera camera = camera_from_field_of_view(640, 480, 60.0);
  EXPECT_NEAR(camera.fx, 554.2563, 1e-3);
  const Eigen::Vector3d point(0.3, -0.2, 1.4);
  const Eigen::Vector3d back = camera.ray(camera.project(point)) * point.z();
  EXPECT_NEAR((back - point).norm(), 0.0, 1e-12);
}

TEST(Camera, ScalingKeepsPixelAreas) {
  const Camera camera = camera_from_field_of_view(640, 480, 60.0);
  const Camera small = camera.scaled_to(160, 120);
  EXPECT_NEAR(small.cx, 79.5, 1e-12);
  EXPECT_NEAR(small.fx, 138.564075, 1e-4);
  const Eigen::Vector3d point(0.3, -0.2, 1.4);
  const Eigen::Vector2d there = camera.pixel_in(small, camera.project(point));
  EXPECT_NEAR((there - small.project(point)).norm(), 0.0, 1e-9);
}

TEST(Camera, RefusesImpossibleFieldsOfView) {
  EXPECT_THROW(camera_from_field_of_view(640, 480, 0.0), Error);
  EXPECT_THROW(camera_from_field_of_view(640, 480, 180.0), Error);
  EXPECT_THROW(camera_from_field_of_view(640, 480, std::nan("")), Error);
}

class CameraFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    auto file = std::filesystem::path(testing::TempDir()) / ("telemime_camera_" + name);
    std::ofstream(file) << text;
    return file;
  }
};

TEST_F(CameraFile, ReadsOpenCvYaml) {
  const auto file = write("a.yaml",
                          "%YAML:1.0\n---\nimage_width: 320\nimage_height: 240\n"
                          "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                          "   data: [ 300., 0., 160., 0., 301., 120., 0., 0., 1. ]\n"
                          "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n"
                          "   data: [ 0.1, 0., 0., 0., 0. ]\n");
  const Camera camera = load_camera(file);
  EXPECT_EQ(camera.width, 320);
  EXPECT_DOUBLE_EQ(camera.fy, 301.0);
}

TEST_F(CameraFile, ReadsPlainJson) {
  const Camera camera = load_camera(write("b.json", R"({"fx": 100, "width": 64, "height": 48})"));
  EXPECT_DOUBLE_EQ(camera.cx, 31.5);
}

TEST_F(CameraFile, NamesTheCauseOfBadFiles) {
  EXPECT_THROW(load_camera("/nonexistent.yaml"), Error);
  EXPECT_THROW(load_camera(write("c.txt", "hello")), Error);
  EXPECT_THROW(load_camera(write("d.json", R"({"fx": -1, "width": 64, "height": 48})")), Error);
  EXPECT_THROW(load_camera(write("e.json", R"({"fx": 100})")), Error);
  EXPECT_THROW(load_camera(write("f.json", "")), Error);
}

TEST(Camera, HeldUprightItIsTheSameCamera) {
  const Camera across = camera_from_field_of_view(1920, 1080, 60.0);
  const Camera upright = camera_from_field_of_view(1080, 1920, 60.0);
  EXPECT_EQ(across.fx, upright.fx);
  EXPECT_EQ(upright.fx, upright.fy);
  EXPECT_NEAR(2.0 * std::atan(0.5 * 1920 / across.fx), std::numbers::pi / 3.0, 1e-12);
  EXPECT_EQ(reference_width(1920, 1080), reference_width(1080, 1920));
  EXPECT_EQ(reference_width(160, 120), 160.0);
}

}  // namespace
}  // namespace telemime
