// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

std::filesystem::path data_folder() {
  const char* named = std::getenv("TELEMIME_DATA");
  return named != nullptr ? std::filesystem::path(named)
                          : std::filesystem::path(TELEMIME_SOURCE_DIR) / ".." / "shared" / "data";
}

std::vector<Frame> frames_of(const std::filesystem::path& file, int most) {
  std::vector<Frame> frames;
  cv::VideoCapture video(file.string());
  cv::Mat image;
  while (static_cast<int>(frames.size()) < most && video.read(image)) {
    frames.push_back({image.clone(), static_cast<std::int64_t>(frames.size()), 0.04 * frames.size()});
  }
  return frames;
}

/// Share of (frame, joint) pairs whose label at the true pixel of the joint is `wanted`.
double agreement(const std::vector<FrameFeatures>& seen, const nlohmann::json& truth,
                 const std::vector<std::string>& joints, Label wanted) {
  const auto names = truth["joints"].get<std::vector<std::string>>();
  const auto& camera = truth["small"];
  int good = 0;
  int all = 0;
  for (std::size_t f = 0; f < seen.size(); ++f) {
    for (const std::string& joint : joints) {
      const auto j = static_cast<std::size_t>(std::find(names.begin(), names.end(), joint) - names.begin());
      const auto p = truth["positions"][f][j].get<std::vector<double>>();
      const double u = camera["fx"].get<double>() * p[0] / p[2] + camera["cx"].get<double>();
      const double v = camera["fy"].get<double>() * p[1] / p[2] + camera["cy"].get<double>();
      if (u >= 1 && v >= 1 && u < 159 && v < 119) {
        ++all;
        const auto label = seen[f].labels.at<unsigned char>(static_cast<int>(std::lround(v)),
                                                            static_cast<int>(std::lround(u)));
        good += label == static_cast<unsigned char>(wanted) ? 1 : 0;
      }
    }
  }
  return all > 0 ? static_cast<double>(good) / all : 0.0;
}

TEST(ImageConfig, RefusesInvalidValues) {
  ImageConfig config;
  EXPECT_NO_THROW(check_settings(config));
  config.width = 3;
  EXPECT_THROW(check_settings(config), Error);
  config = {};
  config.edges.low = 20;
  EXPECT_THROW(check_settings(config), Error);
  config = {};
  config.shadow.darkest = 1.5F;
  EXPECT_THROW(check_settings(config), Error);
}

TEST(ImageConfig, WorkingImageKeepsPixelCountAndIsSquare) {
  ImageConfig config;
  config.width = 320;
  config.height = 240;
  Camera anamorphic = camera_from_field_of_view(720, 576, 60.0);
  anamorphic.fy = 0.75 * anamorphic.fx;
  std::vector<Camera> cameras = {anamorphic};
  for (const auto& [width, height] :
       {std::pair(1280, 720), {720, 720}, {540, 720}, {1080, 1920}, {352, 288}}) {
    cameras.push_back(camera_from_field_of_view(width, height, 60.0));
  }
  for (const Camera& camera : cameras) {
    const ImageConfig fitted = fitted_to(config, camera);
    const Camera working = camera.scaled_to(fitted.width, fitted.height);
    EXPECT_NEAR(working.fy / working.fx, 1.0, 0.01) << camera.width << "x" << camera.height;
    EXPECT_NEAR(fitted.width * fitted.height / (320.0 * 240.0), 1.0, 0.02);
    const ImageConfig again = fitted_to(fitted, camera);
    EXPECT_EQ(again.width, fitted.width);
    EXPECT_EQ(again.height, fitted.height);
  }
}

TEST(ImageConfig, FittedWorkingImageIsNotFittedAgain) {
  for (const auto& [columns, rows] : {std::pair(40, 30),
                                      {44, 33},
                                      {60, 45},
                                      {72, 54},
                                      {100, 75},
                                      {112, 84},
                                      {140, 105},
                                      {160, 120},
                                      {320, 240},
                                      {640, 480},
                                      {1920, 1440}}) {
    for (int width = 200; width < 3000; width += 7) {
      ImageConfig config;
      config.width = columns;
      config.height = rows;
      const Camera camera = camera_from_field_of_view(width, 720, 60.0);
      const ImageConfig fitted = fitted_to(config, camera);
      const ImageConfig again = fitted_to(fitted, camera);
      EXPECT_EQ(std::pair(again.width, again.height), std::pair(fitted.width, fitted.height))
          << columns << "x" << rows << " of " << width << "x720";
    }
  }
}

TEST(ImageConfig, SquarePixelsStayAndOddShapesStayValid) {
  ImageConfig config;
  config.width = 320;
  config.height = 240;
  for (const auto& [width, height] : {std::pair(640, 480), {1600, 1200}, {322, 240}}) {
    const ImageConfig fitted = fitted_to(config, camera_from_field_of_view(width, height, 60.0));
    EXPECT_EQ(fitted.width, 320) << width;
    EXPECT_EQ(fitted.height, 240) << width;
  }
  for (const auto& [width, height] : {std::pair(8000, 20), {20, 8000}}) {
    const Camera camera = camera_from_field_of_view(width, height, 60.0);
    EXPECT_NO_THROW(check_settings(fitted_to(config, camera))) << width;
  }
}

TEST(ImageConfig, FocalLengthIsThatOfTheCamera) {
  for (const double degrees : {43.6, 60.0, 90.0}) {
    const ImageConfig fitted = fitted_to(ImageConfig(), camera_from_field_of_view(1280, 720, degrees));
    EXPECT_NEAR(fitted.segmentation.focal_length, 0.5 / std::tan(degrees / 2 * M_PI / 180), 1e-3) << degrees;
  }
}

TEST(ImageConfig, MissingCascadeIsAnErrorNamingTheFolder) {
  ImageConfig config;
  config.cascades = "/no/such/folder";
  const std::string message =
      testing_errors::message_of(ErrorKind::config, [&] { FeatureExtractor features(config); });
  EXPECT_TRUE(testing_errors::names(message, "/no/such/folder")) << message;
}

TEST(FeatureExtractor, BlackImageGivesEmptyFeaturesOfRightSize) {
  FeatureExtractor features(ImageConfig{});
  const Frame black{cv::Mat::zeros(480, 640, CV_8UC3), 0, 0.0};
  const std::vector<Frame> empty(3, black);
  features.learn_background(empty);
  EXPECT_FALSE(features.learn_person(black).accepted);
  const FrameFeatures seen = features.extract(black);
  EXPECT_EQ(seen.labels.size(), cv::Size(160, 120));
  EXPECT_EQ(seen.labels.type(), CV_8UC1);
  EXPECT_EQ(seen.distance.type(), CV_32FC1);
  EXPECT_EQ(cv::countNonZero(seen.silhouette), 0);
  EXPECT_EQ(cv::norm(seen.distance - 10, cv::NORM_INF), 0);
  EXPECT_FALSE(seen.head.has_value());
  EXPECT_FALSE(features.status().person);
  EXPECT_THROW(features.extract(Frame{}), Error);
}

TEST(FeatureExtractor, PreparesAgainForAnotherImage) {
  cv::Mat dark(120, 160, CV_8UC3);
  cv::randu(dark, cv::Scalar::all(40), cv::Scalar::all(120));
  cv::Mat bright;
  dark.convertTo(bright, -1, 1.8);
  FeatureExtractor features(ImageConfig{});
  features.learn_background(std::vector<Frame>(3, {bright, 0, 0.0}));
  features.extract({bright, 0, 0.0});
  // In the light of the first background, the frame would differ from the second.
  const Frame frame{dark, 1, 0.04};
  features.prepare(frame);
  features.learn_background(std::vector<Frame>(3, {dark, 0, 0.0}));
  EXPECT_EQ(cv::countNonZero(features.extract(frame).silhouette), 0);
  // What was prepared for another frame is not taken for this one.
  cv::Mat other = dark.clone();
  other(cv::Rect(40, 30, 80, 90)).setTo(cv::Scalar(30, 30, 220));
  features.prepare({other, 2, 0.08});
  EXPECT_EQ(cv::countNonZero(features.extract({dark, 3, 0.12}).silhouette), 0);
}

TEST(FeatureExtractor, PreparesAgainForAnotherPerson) {
  const std::filesystem::path demo = TELEMIME_SOURCE_DIR "/data/demo";
  const auto background = frames_of(demo / "background.mp4", 20);
  const auto frames = frames_of(demo / "video.mp4", 2);
  const auto labels = [&](bool prepares) {
    FeatureExtractor features(ImageConfig{});
    features.learn_background(background);
    features.extract(frames[0]);
    if (prepares) {
      features.prepare(frames[1]);
    }
    EXPECT_TRUE(features.learn_person(frames[1]).accepted);
    return features.extract(frames[1]).labels;
  };
  // Without the colours of the person, there would be no arms.
  const cv::Mat plain = labels(false);
  EXPECT_GT(cv::countNonZero(plain == static_cast<int>(Label::arms)), 0);
  EXPECT_EQ(cv::countNonZero(plain != labels(true)), 0);
}

class OnClip : public testing::TestWithParam<const char*> {};

TEST_P(OnClip, LabelsMatchTrueJointsAndRepeat) {
  const std::filesystem::path clip = data_folder() / GetParam();
  if (!std::filesystem::exists(clip / "truth.json")) {
    GTEST_SKIP() << "no test clip at " << clip;
  }
  const auto background = frames_of(clip / "background.mp4", 40);
  const auto frames = frames_of(clip / "video.mp4", 60);
  nlohmann::json truth;
  std::ifstream(clip / "truth.json") >> truth;
  FeatureExtractor features(ImageConfig{});
  features.learn_background(background);
  const FrameFeatures nobody = features.extract(background.front());
  EXPECT_EQ(cv::countNonZero(nobody.silhouette), 0);
  const PersonReport report = features.learn_person(frames.front());
  ASSERT_TRUE(report.accepted) << report.reason;
  FeatureExtractor again(ImageConfig{});
  again.learn_background(background);
  again.extract(background.front());
  again.learn_person(frames.front());
  std::vector<FrameFeatures> seen;
  for (const Frame& frame : frames) {
    seen.push_back(features.extract(frame));
    const FrameFeatures second = again.extract(frame);
    ASSERT_EQ(cv::countNonZero(seen.back().labels != second.labels), 0);
    ASSERT_EQ(cv::countNonZero(seen.back().edges != second.edges), 0);
    ASSERT_TRUE(seen.back().head.has_value());
    EXPECT_GT(cv::countNonZero(seen.back().edges), 100);
  }
  EXPECT_GT(agreement(seen, truth, {"l_wrist", "r_wrist"}, Label::arms), 0.9);
  EXPECT_GT(agreement(seen, truth, {"head"}, Label::head), 0.99);
}

INSTANTIATE_TEST_SUITE_P(Dev, OnClip,
                         testing::Values("dev/raising_arms", "dev/exclaiming", "dev/asking",
                                         "dev_practical/desk_talk"));

TEST(FeatureExtractor, FindsEmptyStartOfClip) {
  const std::filesystem::path clip = data_folder() / "dev_practical/enter_leave/video.mp4";
  if (!std::filesystem::exists(clip)) {
    GTEST_SKIP() << "no test clip at " << clip;
  }
  const auto frames = frames_of(clip, 100);
  FeatureExtractor features(ImageConfig{});
  const std::string sentence = features.bootstrap(frames);
  std::size_t count = 0;
  std::size_t first = 0;
  ASSERT_EQ(std::sscanf(sentence.c_str(),
                        "the background was learned from %zu frames without a person, starting at frame %zu",
                        &count, &first),
            2)
      << sentence;
  EXPECT_EQ(first, 0U);
  // The person walks in at frame 29.
  EXPECT_LE(count, 29U);
  EXPECT_GE(count, 20U);
  features.extract(frames[10]);
  EXPECT_FALSE(features.status().person);
  features.extract(frames[90]);
  EXPECT_TRUE(features.status().person);
}

TEST(FeatureExtractor, HeadKeepsItsSizeAtFirstDetection) {
  const std::filesystem::path clip = data_folder() / "dev_practical/enter_leave/video.mp4";
  if (!std::filesystem::exists(clip)) {
    GTEST_SKIP() << "no test clip at " << clip;
  }
  const auto frames = frames_of(clip, 76);
  ImageConfig config;
  config.width = 320;
  config.height = 240;
  FeatureExtractor features(config);
  features.bootstrap(frames);
  // The person walks in, seen from the side: the outline gives the head until the face is detected.
  std::size_t f = 35;
  while (f < frames.size() && !features.learn_person(frames[f]).accepted) {
    ++f;
  }
  ASSERT_LT(f, 50U);
  bool by_outline = false;
  bool by_face = false;
  double before = 0.0;
  for (; f < frames.size(); ++f) {
    const FrameFeatures seen = features.extract(frames[f]);
    ASSERT_TRUE(seen.head.has_value()) << f;
    by_outline = by_outline || !seen.head->detected;
    by_face = by_face || (by_outline && seen.head->detected);
    const double area = seen.head->radii.x() * seen.head->radii.y();
    if (before > 0.0) {
      EXPECT_NEAR(area / before, 1.0, 0.2) << f;
    }
    before = area;
  }
  EXPECT_TRUE(by_outline);
  EXPECT_TRUE(by_face);
}

// The bundled clip with times at `rate`; `change` makes each picture another one.
std::vector<Frame> demo_frames(std::size_t count, double rate,
                               const std::function<cv::Mat(const cv::Mat&, double)>& change = nullptr) {
  const cv::Mat picture =
      frames_of(std::filesystem::path(TELEMIME_SOURCE_DIR) / "data/demo/video.mp4", 1).at(0).image;
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < count; ++i) {
    const double time = static_cast<double>(i) / rate;
    frames.push_back({change ? change(picture, time) : picture, static_cast<std::int64_t>(i), time});
  }
  return frames;
}

cv::Mat grey_of(const cv::Mat& picture) {
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  cv::cvtColor(grey, grey, cv::COLOR_GRAY2BGR);
  return grey;
}

cv::Mat shifted(const cv::Mat& picture, double right) {
  cv::Mat out;
  cv::warpAffine(picture, out, cv::Matx23d(1, 0, right, 0, 1, 0), picture.size(), cv::INTER_LINEAR,
                 cv::BORDER_REFLECT);
  return out;
}

ImageConfig without_networks() {
  ImageConfig config;
  config.landmarks = false;
  return config;
}

TEST(FeatureExtractor, AnInfraredPictureHasNoColour) {
  for (const double rate : {5.0, 25.0, 60.0}) {
    FeatureExtractor features(without_networks());
    const auto switches = [](const cv::Mat& picture, double time) {
      return time < 1.0 ? picture : grey_of(picture);
    };
    for (const Frame& frame : demo_frames(static_cast<std::size_t>(1.3 * rate) + 1, rate, switches)) {
      features.extract(frame);
      if (frame.time < 1.0 || frame.time > 1.21) {
        EXPECT_EQ(has_colour(features.status()), frame.time < 1.0) << rate << ": " << frame.time;
      }
    }
  }
}

TEST(FeatureExtractor, ANewBackgroundForgetsThatTheCameraMoved) {
  FeatureExtractor features(without_networks());
  const auto pan = [](const cv::Mat& picture, double time) { return shifted(picture, 40.0 * time); };
  features.bootstrap(demo_frames(40, 25.0));
  for (const Frame& frame : demo_frames(60, 25.0, pan)) {
    features.extract(frame);
  }
  ASSERT_GT(features.status().camera_motion, kBackgroundIsVoid);
  features.learn_background(demo_frames(5, 25.0));
  features.extract(demo_frames(1, 25.0).front());
  EXPECT_EQ(features.status().known_background, 1.0);
}

// What comes directly after a pause does not replace all that was learned before.
TEST(FeatureExtractor, OneFrameAfterAPauseTeachesLittle) {
  FeatureExtractor features(without_networks());
  features.learn_background(
      frames_of(std::filesystem::path(TELEMIME_SOURCE_DIR) / "data/demo/background.mp4", 10));
  Frame frame = demo_frames(1, 25.0).front();
  features.extract(frame);
  const cv::Mat before = features.calibration().background.mean.l.clone();
  cv::Mat brighter;
  frame.image.convertTo(brighter, -1, 1.05);
  features.extract({brighter, 1, 60.0});
  const cv::Mat change = cv::abs(features.calibration().background.mean.l - before);
  EXPECT_LT(cv::mean(change)[0], 0.01);
}

// A slow pan is one at any rate.
TEST(FeatureExtractor, AMovingCameraIsNoticedAtAnyRate) {
  const auto pan = [](const cv::Mat& picture, double time) { return shifted(picture, 14.0 * time); };
  for (const double rate : {25.0, 60.0, 120.0}) {
    FeatureExtractor features(without_networks());
    const auto count = static_cast<std::size_t>(1.6 * rate);
    EXPECT_TRUE(features.bootstrap(demo_frames(count, rate, pan)).starts_with("the camera moves")) << rate;
    EXPECT_FALSE(features.bootstrap(demo_frames(count, rate)).starts_with("the camera moves")) << rate;
  }
}

}  // namespace
}  // namespace telemime
