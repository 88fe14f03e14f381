// SPDX-License-Identifier: Apache-2.0
// What is found in poor pictures of a person who faces the camera.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/needs.h"
#include "support/pictures.h"
#include "telemime/capture/source.h"
#include "telemime/image/features.h"
#include "telemime/image/person_finder.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;
using Index = PoseLandmarkIndex;

const fs::path kModels = TELEMIME_BUILD_MODELS;

class PoorPictures : public support::WithNetworks {};

cv::Mat blurred(const cv::Mat& picture) {
  cv::Mat out;
  cv::GaussianBlur(picture, out, {}, picture.cols / 250.0);
  return out;
}

// A dark room and the noise of its camera.
cv::Mat dark(const cv::Mat& picture) {
  cv::Mat out;
  picture.convertTo(out, CV_32FC3, 1.0 / 255.0);
  cv::pow(out, 1.4, out);
  cv::Mat noise(out.size(), out.type());
  cv::theRNG().state = 5;
  cv::randn(noise, 0.0, 7.0);
  out = 0.3 * 255.0 * out + noise;
  out.convertTo(out, CV_8UC3);
  return out;
}

TEST_F(PoorPictures, SidesOfAPersonWhoFacesTheCameraStay) {
  const fs::path clip = support::test_data() / "real/pose2sim_cam2/clip.mp4";
  if (!fs::exists(clip)) {
    GTEST_SKIP() << support::kNoClips;
  }
  const std::vector<std::pair<std::string, std::function<cv::Mat(const cv::Mat&)>>> pictures = {
      {"blurred", blurred}, {"grey", support::grey}, {"dark", dark}};
  for (const auto& [name, made] : pictures) {
    PersonFinder finder(kModels);
    const std::unique_ptr<Source> source = open_source(clip.string());
    std::string exchanged;
    int found = 0;
    for (std::optional<Frame> frame = source->next(); frame; frame = source->next()) {
      const auto person = finder.find(made(frame->image), frame->time);
      if (!person) {
        continue;
      }
      ++found;
      if (person->points[Index::left_shoulder].pixel.x() <
          person->points[Index::right_shoulder].pixel.x() - 20.0) {
        exchanged += " " + std::to_string(frame->index);
      }
    }
    EXPECT_GE(found, 95) << name;
    EXPECT_EQ(exchanged, "") << name;
  }
}

TEST_F(PoorPictures, GreyPicturesTeachNoColours) {
  Frame frame = open_source(TELEMIME_SOURCE_DIR "/data/demo/video.mp4")->next().value();
  Frame colourless = frame;
  colourless.image = support::grey(frame.image);
  ImageConfig config;
  config.models = kModels;
  FeatureExtractor features(config);
  const PersonReport refused = features.learn_person(colourless);
  EXPECT_FALSE(refused.accepted);
  EXPECT_NE(refused.reason.find("no colour"), std::string::npos) << refused.reason;
  EXPECT_TRUE(features.learn_person(frame).accepted);
}

TEST_F(PoorPictures, ARefusedFrameLeavesTheHead) {
  const auto radii = [](bool refused) {
    const std::unique_ptr<Source> source = open_source(TELEMIME_SOURCE_DIR "/data/demo/video.mp4");
    ImageConfig config;
    config.models = kModels;
    FeatureExtractor features(config);
    Frame frame = source->next().value();
    EXPECT_TRUE(features.learn_person(frame).accepted);
    for (int i = 0; i < 5; ++i) {
      features.extract(frame);
      frame = source->next().value();
    }
    if (refused) {
      Frame nobody = frame;
      nobody.image = cv::Mat(frame.image.size(), CV_8UC3, cv::Scalar(90, 140, 60));
      nobody.image.colRange(0, 200).setTo(cv::Scalar(30, 40, 160));
      EXPECT_FALSE(features.learn_person(nobody).accepted);
      frame.index += 1;
    }
    const FrameFeatures seen = features.extract(frame);
    return seen.head ? seen.head->radii : Eigen::Vector2d::Zero().eval();
  };
  const Eigen::Vector2d usual = radii(false);
  EXPECT_GT(usual.norm(), 0.0);
  EXPECT_LT((radii(true) - usual).norm(), 0.1);
}

TEST(Overexposure, IsNamed) {
  const auto warns = [](double gain) {
    ImageConfig config;
    config.landmarks = false;
    FeatureExtractor features(config);
    const std::unique_ptr<Source> source = open_source(TELEMIME_SOURCE_DIR "/data/demo/video.mp4");
    std::optional<Frame> frame = source->next();
    features.learn_person(*frame);
    frame->image.convertTo(frame->image, -1, gain);
    features.extract(*frame);
    const auto& warnings = features.status().warnings;
    return std::any_of(warnings.begin(), warnings.end(), [](const std::string& words) {
      return words.find("the image is overexposed") != std::string::npos;
    });
  };
  EXPECT_FALSE(warns(1.0));
  EXPECT_TRUE(warns(2.5));
}

}  // namespace
}  // namespace telemime
