// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/lens.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "telemime/core/scratch_folder.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

std::string yaml(const std::string& numbers, int count, const std::string& more = "") {
  return "%YAML:1.0\n---\nimage_width: 320\nimage_height: 240\n" + more +
         "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
         "   data: [ 277., 0., 159.5, 0., 277., 119.5, 0., 0., 1. ]\n"
         "distortion_coefficients: !!opencv-matrix\n   rows: " +
         std::to_string(count) + "\n   cols: 1\n   dt: d\n   data: [ " + numbers + " ]\n";
}

Lens loaded(const std::string& text, const std::string& name = "a:b.yml") {
  const ScratchFolder scratch;
  std::ofstream(scratch.file(name)) << text;
  return load_lens(scratch.file(name));
}

std::string refusal(const std::string& text) {
  return error_of(ErrorKind::config, [&] { loaded(text); });
}

TEST(Lens, AllModelsOfOpenCvAreRead) {
  EXPECT_FALSE(loaded(yaml("0., 0., 0., 0., 0.", 5)).distorts());
  EXPECT_EQ(loaded(yaml("-0.23, 0.159, 0., 0., -0.146", 5)).coefficients.size(), 5U);
  EXPECT_EQ(loaded(yaml("12.1, -3.2, 0., 0., 0.5, 12.2, -2.1, 0.9", 8)).coefficients[5], 12.2);
  EXPECT_EQ(loaded(yaml("1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11., 12., 0., 0.", 14)).coefficients.size(),
            12U);
  EXPECT_TRUE(loaded(yaml("0.02, -0.01, 0.003, -0.001", 4, "fisheye_model: 1\n")).fisheye);
  EXPECT_TRUE(loaded(yaml("0., 0., 0., 0.", 4, "distortion_model: equidistant\n")).distorts());
  EXPECT_FALSE(loaded(yaml("0.02, -0.01, 0.003, -0.001", 4, "distortion_model: plumb_bob\n")).fisheye);
  EXPECT_TRUE(
      loaded(R"({"fx": 100, "width": 64, "height": 48, "fisheye": true, "distortion": [0.1, 0, 0, 0]})")
          .fisheye);
}

TEST(Lens, WhatCannotBeUsedIsRefused) {
  EXPECT_NE(refusal(yaml("0.02, -0.01, 0.003, -0.001", 4)).find("fisheye_model"), std::string::npos);
  EXPECT_NE(refusal(yaml("1., 2., 3., 4., 5., 6.", 6)).find("6 distortion_coefficients"), std::string::npos);
  EXPECT_NE(refusal(yaml("1., 2., 3., 4., 5.", 5, "fisheye_model: 1\n")).find("a fisheye lens has 4"),
            std::string::npos);
  EXPECT_NE(refusal(yaml("1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11., 12., 0.1, 0.", 14)).find("tilt"),
            std::string::npos);
  EXPECT_NE(refusal(yaml(".Nan, 2., 3., 4., 5.", 5)).find("finite"), std::string::npos);
  EXPECT_NE(refusal(yaml("1., 2., 3., 4.", 4, "distortion_model: mei\n")).find("'mei'"), std::string::npos);
}

// By hand, from the formulas of OpenCV's documentation.
TEST(Lens, PointsLieWhereOpenCvHasThem) {
  const Eigen::Vector2d point(0.3, -0.4);  // r = 0.5
  Lens lens;
  EXPECT_EQ(lens.distorted(point), point);
  lens.coefficients = {0.1, 0.2, 0.01, 0.02, 0.3};
  const double radial = 1.0 + 0.1 / 4.0 + 0.2 / 16.0 + 0.3 / 64.0;
  EXPECT_NEAR(lens.distorted(point).x(), 0.3 * radial - 2.0 * 0.01 * 0.12 + 0.02 * (0.25 + 0.18), 1e-12);
  EXPECT_NEAR(lens.distorted(point).y(), -0.4 * radial + 0.01 * (0.25 + 0.32) - 2.0 * 0.02 * 0.12, 1e-12);
  lens.coefficients = {0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0};
  EXPECT_NEAR(lens.distorted(point).x(), 0.3 / 1.25, 1e-12);
  lens = {.camera = {}, .fisheye = true, .coefficients = {0.1, 0.0, 0.0, 0.0}};
  const double angle = std::atan(0.5);
  EXPECT_NEAR(lens.distorted(point).norm(), angle * (1.0 + 0.1 * angle * angle), 1e-12);
}

TEST(Lens, AMirroredLensMirrorsItsPoints) {
  for (const bool fisheye : {false, true}) {
    Lens lens{.camera = {}, .fisheye = fisheye, .coefficients = {0.1, -0.2, 0.01, 0.02}};
    if (!fisheye) {
      lens.coefficients.insert(lens.coefficients.end(), {0.3, 0.1, 0.2, 0.05, 0.01, 0.02, 0.03, 0.04});
    }
    const Eigen::Vector2d straight = lens.distorted({0.2, 0.3});
    const Eigen::Vector2d mirrored = lens.mirrored().distorted({-0.2, 0.3});
    EXPECT_NEAR(mirrored.x(), -straight.x(), 1e-12);
    EXPECT_NEAR(mirrored.y(), straight.y(), 1e-12);
  }
}

}  // namespace
}  // namespace telemime
