// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/camera_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

#include "telemime/core/random.h"

namespace telemime {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

// A larger picture of furniture, so that a camera can move over it.
cv::Mat room() {
  Random random(1);
  cv::Mat image(kHeight + 80, kWidth + 80, CV_8UC1, cv::Scalar(120));
  for (int i = 0; i < 60; ++i) {
    const cv::Rect box(static_cast<int>(random.uniform(0, image.cols - 30)),
                       static_cast<int>(random.uniform(0, image.rows - 40)),
                       static_cast<int>(random.uniform(8, 30)), static_cast<int>(random.uniform(8, 40)));
    image(box).setTo(random.uniform(40, 220));
  }
  return image;
}

// What a camera sees that was shifted by (x, y), turned and zoomed.
cv::Mat seen(const cv::Mat& scene, double x, double y, double degrees = 0.0, double zoom = 1.0) {
  cv::Mat matrix = cv::getRotationMatrix2D({kWidth / 2.0 + 40, kHeight / 2.0 + 40}, degrees, zoom);
  matrix.at<double>(0, 2) += x - 40;
  matrix.at<double>(1, 2) += y - 40;
  cv::Mat out;
  cv::warpAffine(scene, out, matrix, {kWidth, kHeight}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return out;
}

cv::Mat noisy(const cv::Mat& image, double deviation, std::uint64_t seed) {
  Random random(seed);
  cv::Mat out = image.clone();
  for (std::size_t i = 0; i < out.total(); ++i) {
    out.data[i] = cv::saturate_cast<unsigned char>(out.data[i] + random.normal(0, deviation));
  }
  return out;
}

cv::Mat everywhere() {
  return {kHeight, kWidth, CV_8UC1, cv::Scalar(255)};
}

double motion(const cv::Mat& before, const cv::Mat& after, const cv::Mat& scene = everywhere()) {
  const auto shared = shared_motion(before, after, scene);
  EXPECT_TRUE(shared) << "too few corners";
  return shared ? shared->pixels : -1.0;
}

TEST(CameraMotion, ShiftIsMeasured) {
  const cv::Mat scene = room();
  const cv::Mat before = noisy(seen(scene, 0, 0), 2, 1);
  for (const auto& [x, y] : {std::pair(0.8, 0.0), {3.0, 0.0}, {-4.0, 5.0}, {12.0, -9.0}}) {
    EXPECT_NEAR(motion(before, noisy(seen(scene, x, y), 2, 2)), std::hypot(x, y),
                0.15 + 0.02 * std::hypot(x, y));
  }
}

TEST(CameraMotion, TurnAndZoomAreMotion) {
  const cv::Mat scene = room();
  EXPECT_GT(motion(seen(scene, 0, 0), seen(scene, 0, 0, 3.0)), 3.0);
  EXPECT_GT(motion(seen(scene, 0, 0), seen(scene, 0, 0, 0.0, 1.05)), 3.0);
}

TEST(CameraMotion, NoiseIsRest) {
  const cv::Mat scene = seen(room(), 0, 0);
  for (const double deviation : {0.0, 2.0, 6.0, 12.0}) {
    const auto shared = shared_motion(noisy(scene, deviation, 3), noisy(scene, deviation, 4), everywhere());
    EXPECT_EQ(shared ? shared->pixels : 0.0, 0.0) << deviation;
  }
}

TEST(CameraMotion, BrightnessIsRest) {
  const cv::Mat scene = seen(room(), 0, 0);
  for (const double gain : {0.4, 0.7, 1.3, 1.8}) {  // the last saturates a third of the picture
    cv::Mat bright;
    scene.convertTo(bright, CV_8UC1, gain);
    EXPECT_EQ(motion(noisy(scene, 2, 5), noisy(bright, 2, 6)), 0.0) << "gain " << gain;
  }
  // A lamp at the side.
  cv::Mat lit = scene.clone();
  for (int r = 0; r < lit.rows; ++r) {
    for (int c = 0; c < lit.cols; ++c) {
      lit.at<unsigned char>(r, c) =
          cv::saturate_cast<unsigned char>(lit.at<unsigned char>(r, c) * (0.6 + 0.002 * c));
    }
  }
  EXPECT_EQ(motion(noisy(scene, 2, 5), noisy(lit, 2, 6)), 0.0);
}

TEST(CameraMotion, IsSeenInSpiteOfBrightness) {
  const cv::Mat scene = room();
  cv::Mat darker;
  seen(scene, 5, 2).convertTo(darker, CV_8UC1, 0.6);
  EXPECT_NEAR(motion(noisy(seen(scene, 0, 0), 2, 7), noisy(darker, 2, 8)), std::hypot(5, 2), 0.5);
}

TEST(CameraMotion, PlainWallCannotTell) {
  const cv::Mat wall(kHeight, kWidth, CV_8UC1, cv::Scalar(140));
  EXPECT_FALSE(shared_motion(wall, wall, everywhere()));
  for (const double deviation : {2.0, 5.0}) {
    const auto shared = shared_motion(noisy(wall, deviation, 9), noisy(wall, deviation, 10), everywhere());
    EXPECT_EQ(shared ? shared->pixels : 0.0, 0.0) << deviation;
  }
  const cv::Mat black(kHeight, kWidth, CV_8UC1, cv::Scalar(0));
  EXPECT_FALSE(shared_motion(black, black, everywhere()));
}

// The picture with a person who covers its right half and moves by (x, y); the mask follows.
cv::Mat with_person(const cv::Mat& image, int x, int y) {
  cv::Mat out = image.clone();
  cv::Mat person = room()(cv::Rect(60 - x, 30 - y, kWidth / 2, kHeight)) * 0.8;
  person.copyTo(out(cv::Rect(kWidth / 2, 0, kWidth / 2, kHeight)));
  return out;
}

TEST(CameraMotion, PersonInHalfOfThePictureIsRest) {
  const cv::Mat scene = room();
  const cv::Mat before = with_person(seen(scene, 0, 0), 0, 0);
  cv::Mat background = everywhere();
  background(cv::Rect(kWidth / 2, 0, kWidth / 2, kHeight)).setTo(0);
  const cv::Mat moved = with_person(seen(scene, 0, 0), 6, 4);
  EXPECT_EQ(motion(before, moved, background), 0.0);
  // Without the mask, too: only half of the corners move.
  EXPECT_EQ(motion(before, moved), 0.0);
  // The camera moves behind the person.
  EXPECT_NEAR(motion(before, with_person(seen(scene, 7, 0), 0, 0), background), 7.0, 0.3);
}

TEST(CameraMotion, SameImagesSameMotion) {
  const cv::Mat scene = room();
  const cv::Mat before = noisy(seen(scene, 0, 0), 4, 11);
  const cv::Mat after = noisy(seen(scene, 2, 1, 1.0), 4, 12);
  EXPECT_EQ(motion(before, after), motion(before, after));
}

// Share of the pairs of frames 8 apart in which these parts of the picture (shares of it) move.
double moving_share(const std::filesystem::path& clip, const std::vector<cv::Rect2d>& background) {
  cv::VideoCapture video(clip.string());
  cv::Mat image;
  std::vector<cv::Mat> frames;
  while (video.read(image)) {
    cv::Mat small;
    const double scale = std::sqrt(kWidth * kHeight / static_cast<double>(image.total()));
    cv::resize(image, small, {}, scale, scale, cv::INTER_AREA);
    cv::cvtColor(small, small, cv::COLOR_BGR2GRAY);
    frames.push_back(small);
  }
  int moving = 0;
  int all = 0;
  for (std::size_t i = 0; i + 8 < frames.size(); i += 8) {
    const cv::Size size = frames[i].size();
    cv::Mat scene = cv::Mat::zeros(size, CV_8UC1);
    for (const cv::Rect2d& part : background) {
      const cv::Point first(static_cast<int>(part.x * size.width), static_cast<int>(part.y * size.height));
      const cv::Point last(static_cast<int>(part.br().x * size.width),
                           static_cast<int>(part.br().y * size.height));
      scene(cv::Rect(first, last)).setTo(255);
    }
    const auto shared = shared_motion(frames[i], frames[i + 8], scene);
    moving += shared && shared->pixels * 160 / kWidth > 0.7 ? 1 : 0;
    ++all;
  }
  return all > 0 ? static_cast<double>(moving) / all : -1.0;
}

TEST(CameraMotion, ClipsMoveOnlyIfTheCameraDoes) {
  const char* named = std::getenv("TELEMIME_DATA");
  if (named == nullptr) {
    GTEST_SKIP() << "TELEMIME_DATA does not name the folder of the clips";
  }
  const std::filesystem::path data(named);
  const std::vector<cv::Rect2d> whole = {{0, 0, 1, 1}};
  EXPECT_EQ(moving_share(data / "trials/light/auto_exposure.mp4", whole), 0.0);
  EXPECT_EQ(moving_share(data / "dev/asking/video.mp4", whole), 0.0);
  EXPECT_EQ(moving_share(data / "real/webcam_hello/clip.mp4", whole), 0.0);
  // Above the shoulders, on both sides of the head.
  EXPECT_GT(moving_share(data / "real/handheld_wave/clip.mp4", {{0, 0, 0.33, 0.45}, {0.73, 0, 0.27, 0.45}}),
            0.3);
}

}  // namespace
}  // namespace telemime
