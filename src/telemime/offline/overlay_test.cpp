// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/overlay.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/tracker/track_frame.h"

namespace telemime {
namespace {

// Middle of everything that is drawn on a black image of that size, as shares of its width and height.
cv::Point2d middle_of_drawing(const cv::Size& size) {
  const Camera camera = camera_from_field_of_view(640, 480, 60.0);
  const Model model = make_model(Shape{});
  MotionFrame motion;
  motion.state = TrackState::tracking;
  motion.pose.root = {0.3, 0.35, 1.5};  // beside the middle of the image
  place_joints(model.body, camera, motion);
  const cv::Mat overlay = draw_overlay(cv::Mat::zeros(size, CV_8UC3),
                                       {.motion = &motion, .model = &model, .camera = camera, .note = ""});
  cv::Mat drawn;
  cv::inRange(overlay.colRange(0, size.width), cv::Scalar(1, 1, 1), cv::Scalar(255, 255, 255), drawn);
  const cv::Moments m = cv::moments(drawn, true);
  return {m.m10 / m.m00 / size.width, m.m01 / m.m00 / size.height};
}

TEST(Overlay, FitsAnImageOfAnySize) {
  const cv::Point2d whole = middle_of_drawing({640, 480});
  EXPECT_GT(whole.x, 0.6);
  for (const cv::Size& size : {cv::Size(320, 240), cv::Size(960, 720)}) {
    const cv::Point2d other = middle_of_drawing(size);
    EXPECT_NEAR(other.x, whole.x, 0.02) << size;
    EXPECT_NEAR(other.y, whole.y, 0.02) << size;
  }
}

}  // namespace
}  // namespace telemime
