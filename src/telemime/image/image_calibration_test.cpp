// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/image_calibration.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <vector>

#include "telemime/core/scratch_folder.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

ImageCalibration some_calibration() {
  ImageCalibration c;
  cv::Mat image(30, 40, CV_8UC3);
  for (int i = 0; i < 30 * 40 * 3; ++i) {
    image.data[i] = static_cast<unsigned char>(i * 7 % 251);
  }
  const std::vector<cv::Mat> images{image};
  c.background = learn_background_model(images);
  c.background.valid.at<unsigned char>(3, 4) = 0;
  ColourGaussian g;
  g.mean = {0.1F, -0.25F, 5.125F};
  g.covariance << 0.01F, 0.001F, 0.002F, 0.001F, 0.02F, 0.003F, 0.002F, 0.003F, 0.3F;
  g.weight = 0.75F;
  c.colours.skin = {g};
  c.colours.clothes = {g, g, g};
  c.colours.other = {g, g};
  c.doubtful = true;
  return c;
}

TEST(CalibrationFile, ReadsWhatWasWritten) {
  const ScratchFolder folder;
  const ImageCalibration before = some_calibration();
  for (const char* name : {"calibration.yml.gz", "calibration.json"}) {
    save_calibration(before, folder.path() / name);
    const ImageCalibration after = load_calibration(folder.path() / name);
    EXPECT_EQ(cv::norm(before.background.mean.u, after.background.mean.u, cv::NORM_INF), 0) << name;
    EXPECT_EQ(
        cv::norm(before.background.luminance_variance, after.background.luminance_variance, cv::NORM_INF), 0);
    EXPECT_EQ(cv::countNonZero(before.background.valid != after.background.valid), 0);
    ASSERT_EQ(after.colours.skin.size(), 1U);
    EXPECT_EQ(after.colours.clothes.size(), 3U);
    EXPECT_EQ(after.colours.other.size(), 2U);
    EXPECT_TRUE(after.colours.hair.empty());
    EXPECT_EQ(after.colours.skin[0].mean, before.colours.skin[0].mean);
    EXPECT_EQ(after.colours.skin[0].covariance, before.colours.skin[0].covariance);
    EXPECT_EQ(after.colours.skin[0].weight, before.colours.skin[0].weight);
    EXPECT_TRUE(after.doubtful);
  }
}

TEST(CalibrationFile, ErrorNamesTheFile) {
  const ScratchFolder folder;
  std::ofstream(folder.path() / "noise.yml") << "not a calibration";
  std::ofstream(folder.path() / "other.yml") << "%YAML:1.0\n---\nsomething: 3\n";
  for (const char* name : {"missing.yml", "noise.yml", "other.yml"}) {
    try {
      load_calibration(folder.path() / name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_TRUE(testing_errors::names(error.what(), name)) << error.what();
    }
  }
  EXPECT_THROW(save_calibration(some_calibration(), folder.path() / "no_such_folder" / "a.yml.gz"), Error);
}

// A file that may not grow stands for a full disk.
TEST(CalibrationFile, AFullDiskIsReportedAndTheOldFileStays) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "calibration.yml.gz";
  save_calibration(some_calibration(), file);
  rlimit usual{};
  getrlimit(RLIMIT_FSIZE, &usual);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{500, usual.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(save_calibration(some_calibration(), file), Error);
  setrlimit(RLIMIT_FSIZE, &usual);
  EXPECT_EQ(load_calibration(file).colours.skin.size(), 1U);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "no part stays";
}

}  // namespace
}  // namespace telemime
