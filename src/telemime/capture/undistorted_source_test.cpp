// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/undistorted_source.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/capture/testing.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

Lens lens_of(std::vector<double> coefficients, bool fisheye = false) {
  return {.camera = camera_from_field_of_view(320, 240, 60.0),
          .fisheye = fisheye,
          .coefficients = std::move(coefficients)};
}

// The middle of a white disc on black.
cv::Point2d middle(const cv::Mat& image) {
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  const cv::Moments m = cv::moments(grey);
  return {m.m10 / m.m00, m.m01 / m.m00};
}

TEST(Undistorted, PointsAreWhereAPinholeSeesThem) {
  const ScratchFolder scratch;
  for (const Lens& lens :
       {lens_of({-0.23, 0.159, 0.01, 0.02, -0.146}), lens_of({12.1, -3.2, 0.0, 0.0, 0.5, 12.2, -2.1, 0.9}),
        lens_of({0.02, -0.01, 0.003, -0.001}, true), lens_of({0.1, 0.0, 0.0, 0.0})}) {
    const Eigen::Vector3d point(0.3, -0.2, 1.0);
    const Eigen::Vector2d bent = lens.distorted(point.head<2>());
    const Eigen::Vector2d pixel = lens.camera.project({bent.x(), bent.y(), 1.0});
    cv::Mat image = cv::Mat::zeros(240, 320, CV_8UC3);
    cv::circle(image,
               cv::Point(static_cast<int>(std::lround(64.0 * pixel.x())),
                         static_cast<int>(std::lround(64.0 * pixel.y()))),
               64 * 3, cv::Scalar::all(255), cv::FILLED, cv::LINE_AA, 6);
    cv::imwrite(scratch.file("a.png"), image);
    const cv::Point2d seen = middle(undistorted(open_source(scratch.file("a.png")), lens)->next()->image);
    const Eigen::Vector2d right = lens.camera.project(point);
    EXPECT_NEAR(seen.x, right.x(), 0.3);
    EXPECT_NEAR(seen.y, right.y(), 0.3);
  }
}

TEST(Undistorted, AnImpossibleLensIsRefused) {
  const ScratchFolder scratch;
  cv::imwrite(scratch.file("a.png"), cv::Mat::zeros(240, 320, CV_8UC3));
  EXPECT_NE(error_of(ErrorKind::config,
                     [&] {
                       undistorted(open_source(scratch.file("a.png")), lens_of({1e6, 0.0, 0.0, 0.0, 0.0}));
                     }),
            "");
}

}  // namespace
}  // namespace telemime
