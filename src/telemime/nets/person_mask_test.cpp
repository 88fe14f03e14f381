// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/person_mask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <span>
#include <string>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/nets/models/table.h"

namespace telemime {
namespace {

const cv::Size kPicture(320, 240);

// Something like a person with a raised arm.
cv::Mat picture() {
  cv::Mat image(kPicture, CV_8UC3, cv::Scalar(120, 90, 70));
  cv::ellipse(image, {160, 200}, {50, 90}, 0, 0, 360, {40, 60, 160}, cv::FILLED);
  cv::ellipse(image, {160, 80}, {25, 35}, 0, 0, 360, {140, 170, 220}, cv::FILLED);
  cv::line(image, {200, 150}, {240, 60}, {140, 170, 220}, 18);
  return image;
}

// The mask as the whole network computes it, in all cells.
cv::Mat whole_mask(Network& network, std::span<const float> input, const PictureRegion& region) {
  const std::span<const float> logits = network.run(input)[0];
  cv::Mat cells(256, 256, CV_8UC1);
  std::transform(logits.begin(), logits.end(), cells.begin<std::uint8_t>(), [](float value) {
    return cv::saturate_cast<std::uint8_t>(
        255.0F * static_cast<float>(1.0 / (1.0 + std::exp(-static_cast<double>(value)))));
  });
  return picture_mask(cells, region, kPicture);
}

TEST(PersonMask, IsThatOfTheWholeNetwork) {
  const std::vector<std::string> names = {"pose_landmark_lite", "pose_landmark_full", "pose_landmark_heavy"};
  if (const std::string missing = missing_models(TELEMIME_BUILD_MODELS, names); !missing.empty()) {
    GTEST_SKIP() << missing;
  }
  // Of the second and third region, the picture shows only the upper or the lower half. The fourth is turned.
  // The middle of the others is at the lower edge of the picture, or some rows of the mask beside it.
  const std::vector<PictureRegion> regions = {
      {.centre = {160, 130}, .width = 240, .height = 240},
      {.centre = {160, 260}, .width = 420, .height = 420},
      {.centre = {160, -20}, .width = 400, .height = 400},
      {.centre = {150, 240}, .width = 400, .height = 400, .angle = 0.25 * std::numbers::pi},
      {.centre = {160, 236}, .width = 420, .height = 420},
      {.centre = {160, 238}, .width = 420, .height = 420},
      {.centre = {160, 239.5}, .width = 420, .height = 420},
      {.centre = {160, 241}, .width = 420, .height = 420},
      {.centre = {160, 243}, .width = 420, .height = 420}};
  for (const PoseModel model : {PoseModel::lite, PoseModel::full, PoseModel::heavy}) {
    const PoseModelFile file = pose_model_file(model);
    Network whole = load_network(TELEMIME_BUILD_MODELS, file.name, {.inputs = {}, .outputs = {file.mask}});
    Network first = load_network(TELEMIME_BUILD_MODELS, file.name,
                                 {.inputs = {}, .outputs = {file.mask_inputs[0], file.mask_inputs[1]}});
    MaskNetworks networks = load_mask_networks(TELEMIME_BUILD_MODELS, model);
    for (const PictureRegion& region : regions) {
      const std::vector<float> input = network_input(picture(), region, {.size = {256, 256}});
      const cv::Mat expected = whole_mask(whole, input, region);
      const auto images = first.run(input);
      const cv::Mat mask = person_mask({.region = region,
                                        .images = {std::vector<float>(images[0].begin(), images[0].end()),
                                                   std::vector<float>(images[1].begin(), images[1].end())}},
                                       kPicture, networks);
      double most = 0.0;
      cv::minMaxLoc(expected, nullptr, &most);
      EXPECT_GT(most, 127.0) << file.name << ": the network sees nothing at all";
      EXPECT_EQ(cv::countNonZero(mask != expected), 0) << file.name << ", region at " << region.centre.y();
    }
  }
}

}  // namespace
}  // namespace telemime
