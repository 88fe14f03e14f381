// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/models/table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <numeric>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"
#include "telemime/core/scratch_folder.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

#define SKIP_WITHOUT_MODELS()                                                   \
  if (!fs::exists(fs::path(TELEMIME_BUILD_MODELS) / "pose_detection.tflite")) { \
    std::cout << "no models: configure with npm and -DTELEMIME_MODELS=ON\n";    \
    GTEST_SKIP() << "no models: configure with npm and -DTELEMIME_MODELS=ON";   \
  }

// What the WebAssembly build of TensorFlow Lite (the npm package @tensorflow/tfjs-tflite 0.0.1-alpha.10)
// computes from bright_ellipse(): mean, root mean square, and five elements from the first to the last. The
// transposed convolution of selfie_segmentation, which it does not know, was computed in double precision.
struct GoldenOutput {
  std::string_view model;
  std::string_view output;
  double mean;
  double rms;
  std::array<double, 5> samples;
};
constexpr GoldenOutput kGolden[] = {
    {"face_detection_short_range",
     "classificators",
     -7.563225,
     11.75448,
     {-4.798779, -5.543927, -5.220149, -5.298556, -51.97971}},
    {"face_detection_short_range",
     "regressors",
     6.985021,
     24.16059,
     {0.08040416, -0.8247808, -0.1849276, -10.74801, -5.157402}},
    {"face_landmark", "conv2d_21", 67.73789, 85.5045, {103.23, 58.11946, 51.55226, 106.2566, 11.83911}},
    {"face_landmark",
     "conv2d_31",
     -1.599647,
     1.599647,
     {-1.599647, -1.599647, -1.599647, -1.599647, -1.599647}},
    {"hand_landmark_full",
     "Identity",
     68.97373,
     87.12048,
     {114.5538, 102.6176, 83.31258, 115.963, -2.496659}},
    {"hand_landmark_full",
     "Identity_1",
     0.03510363,
     0.03510363,
     {0.03510363, 0.03510363, 0.03510363, 0.03510363, 0.03510363}},
    {"hand_landmark_full",
     "Identity_2",
     0.4621339,
     0.4621339,
     {0.4621339, 0.4621339, 0.4621339, 0.4621339, 0.4621339}},
    {"hand_landmark_full",
     "Identity_3",
     -0.003419263,
     0.02441112,
     {0.001989412, -0.005536067, -0.0322332, -0.004238833, 0.006072325}},
    {"hand_landmark_lite",
     "Identity",
     70.40784,
     87.50509,
     {123.7578, 101.383, 87.03378, 119.3063, -13.59153}},
    {"hand_landmark_lite",
     "Identity_1",
     0.002418933,
     0.002418933,
     {0.002418933, 0.002418933, 0.002418933, 0.002418933, 0.002418933}},
    {"hand_landmark_lite",
     "Identity_2",
     0.5196718,
     0.5196718,
     {0.5196718, 0.5196718, 0.5196718, 0.5196718, 0.5196718}},
    {"hand_landmark_lite",
     "Identity_3",
     -0.006629345,
     0.01429764,
     {-0.001914397, -0.01344955, -0.01001065, 0.002340592, -0.01665836}},
    {"hand_recrop", "output_crop", 156.2795, 162.6146, {138.5763, 115.8841, 138.1694, 138.1694, 232.4882}},
    {"pose_detection",
     "Identity",
     2.544997,
     41.52417,
     {-8.906244, -21.12638, 1.690584, -12.7969, 0.07859945}},
    {"pose_detection",
     "Identity_1",
     -44.69783,
     64.60416,
     {-70.22876, -3.241512, -6.91709, -56.78607, -29.66471}},
    {"pose_landmark_full",
     "Identity",
     49.48737,
     82.87599,
     {137.1239, 158.0241, -6.305012, 158.7196, -0.1393225}},
    {"pose_landmark_full",
     "Identity_1",
     0.1046146,
     0.1046146,
     {0.1046146, 0.1046146, 0.1046146, 0.1046146, 0.1046146}},
    {"pose_landmark_full",
     "Identity_2",
     -50.98447,
     221.7274,
     {-78.99416, -0.093494, -283.4396, 136.4606, -6.792197}},
    {"pose_landmark_full",
     "Identity_3",
     -9.714068,
     11.77879,
     {-32.11934, -2.872149, -20.75729, -1.898428, -7.702709}},
    {"pose_landmark_full",
     "Identity_4",
     -0.03263012,
     0.2250574,
     {0.008408988, 0.1325682, -0.0353859, 0.1871879, 0.06442597}},
    {"pose_landmark_heavy",
     "Identity",
     37.99137,
     78.00674,
     {125.9319, 137.0195, -23.01766, 121.5504, -3.947145}},
    {"pose_landmark_heavy",
     "Identity_1",
     0.3991583,
     0.3991583,
     {0.3991583, 0.3991583, 0.3991583, 0.3991583, 0.3991583}},
    {"pose_landmark_heavy",
     "Identity_2",
     -27.70327,
     33.56185,
     {-3.218461, -1.619946, -18.33103, -12.38943, -6.32014}},
    {"pose_landmark_heavy",
     "Identity_3",
     -11.69406,
     15.68946,
     {-27.75463, -2.354988, -19.10728, -4.304975, -75.25748}},
    {"pose_landmark_heavy",
     "Identity_4",
     -0.02886251,
     0.6358856,
     {0.006055059, 0.1289171, -0.3256249, 0.004655337, 0.9757775}},
    {"pose_landmark_lite", "Identity", 44.69158, 79.20863, {136.0773, 151.34, -12.27082, 127.6684, 3.294354}},
    {"pose_landmark_lite",
     "Identity_1",
     0.9752922,
     0.9752922,
     {0.9752922, 0.9752922, 0.9752922, 0.9752922, 0.9752922}},
    {"pose_landmark_lite",
     "Identity_2",
     -53.69372,
     70.00263,
     {-16.81441, -203.8544, -23.53447, -63.07185, -20.49978}},
    {"pose_landmark_lite",
     "Identity_3",
     -8.297425,
     10.82991,
     {-8.412212, -3.174201, -12.36691, -5.302333, -9.414577}},
    {"pose_landmark_lite",
     "Identity_4",
     -0.05049247,
     0.3014177,
     {0.01919897, 0.1308918, -0.1161259, -0.06909435, 0.2398108}},
    {"selfie_segmentation", "activation_10", 0.0003699991, 0.00915597, {1.939809e-24, 0, 6.783406e-41, 0, 0}},
    {"selfie_segmentation_landscape",
     "segment_back",
     0.2806098,
     0.5277984,
     {0, 3.349103e-43, 3.989076e-39, 2.438259e-42, 2.35503e-36}},
};

// A bright ellipse on a dark ground with a little texture.
std::vector<float> bright_ellipse(const TensorShape& shape) {
  constexpr std::array<double, 3> kInside = {0.8, 0.6, 0.5};
  constexpr std::array<double, 3> kOutside = {0.2, 0.3, 0.4};
  std::vector<float> image;
  for (int y = 0; y < shape[1]; ++y) {
    for (int x = 0; x < shape[2]; ++x) {
      const double dx = (2 * x + 1.0) / shape[2] - 1.0;
      const double dy = (2 * y + 1.0) / shape[1] - 1.0;
      const bool inside = dx * dx * 4 + dy * dy * 2 < 1;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const auto texture = static_cast<std::uint32_t>(image.size()) * 0x9E3779B1U >> 8U & 0xFFU;
        image.push_back(static_cast<float>((inside ? kInside : kOutside)[channel] + texture / 2048.0));
      }
    }
  }
  return image;
}

std::vector<char> read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Models, AreSortedByName) {
  const auto table = model_table();
  EXPECT_TRUE(std::is_sorted(table.begin(), table.end(),
                             [](const auto& a, const auto& b) { return a.name < b.name; }));
  for (const ModelFile& model : table) {
    EXPECT_EQ(model.sha256.size(), 64U) << model.name;
  }
}

TEST(Models, UnknownNameListsTheNames) {
  try {
    model_named("pose");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("pose_landmark_full"), std::string::npos);
  }
}

TEST(Models, MissingOnesAreNamedWithARemedy) {
  const ScratchFolder folder;
  const std::vector<std::string> names = {"hand_recrop", "face_landmark"};
  std::ofstream(folder.file("hand_recrop.tflite")) << "x";
  const std::string missing = missing_models(folder.path(), names);
  EXPECT_EQ(missing.find("hand_recrop"), std::string::npos);
  EXPECT_NE(missing.find("there is no face_landmark.tflite in " + folder.path().string()), std::string::npos);
  EXPECT_NE(missing.find("TELEMIME_MODELS"), std::string::npos);
  EXPECT_NE(missing_models({}, names), "");
  EXPECT_THROW(load_network(folder.path(), "face_landmark"), Error);
}

TEST(Models, GivenFolderIsTaken) {
  EXPECT_EQ(find_models("/some/folder"), fs::path("/some/folder"));
}

TEST(Models, RefusesFileOfAnotherContent) {
  SKIP_WITHOUT_MODELS();
  const ScratchFolder folder;
  std::vector<char> bytes = read_file(fs::path(TELEMIME_BUILD_MODELS) / "hand_recrop.tflite");
  bytes[bytes.size() / 2] ^= 1;
  std::ofstream(folder.file("hand_recrop.tflite"), std::ios::binary).write(bytes.data(), std::ssize(bytes));
  EXPECT_THROW(load_network(folder.path(), "hand_recrop"), Error);
  bytes[bytes.size() / 2] ^= 1;
  std::ofstream(folder.file("hand_recrop.tflite"), std::ios::binary).write(bytes.data(), std::ssize(bytes));
  EXPECT_NO_THROW(load_network(folder.path(), "hand_recrop"));
  std::ofstream(folder.file("hand_recrop.tflite"), std::ios::binary | std::ios::app) << "x";
  EXPECT_THROW(load_network(folder.path(), "hand_recrop"), Error);
}

TEST(Models, ComputeWhatTensorFlowLiteComputes) {
  SKIP_WITHOUT_MODELS();
  for (const ModelFile& model : model_table()) {
    std::vector<GoldenOutput> expected;
    std::vector<std::string> names;
    for (const GoldenOutput& golden : kGolden) {
      if (golden.model == model.name) {
        expected.push_back(golden);
        names.emplace_back(golden.output);
      }
    }
    ASSERT_FALSE(expected.empty()) << model.name << " has no golden output";
    Network network = load_network(TELEMIME_BUILD_MODELS, model.name, names);
    const auto outputs = network.run(bright_ellipse(network.input_shape()));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const std::span<const float> values = outputs[i];
      const std::string where = std::string(model.name) + ", " + names[i];
      const double tolerance = 1e-3 * expected[i].rms;
      const auto count = static_cast<double>(values.size());
      const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
      const double square = std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / count;
      EXPECT_NEAR(mean, expected[i].mean, tolerance) << where;
      EXPECT_NEAR(std::sqrt(square), expected[i].rms, tolerance) << where;
      const std::size_t size = values.size();
      const std::array<std::size_t, 5> places = {0, size / 3, size / 2, 2 * size / 3, size - 1};
      for (std::size_t k = 0; k < places.size(); ++k) {
        EXPECT_NEAR(values[places[k]], expected[i].samples[k], tolerance)
            << where << ", element " << places[k];
      }
    }
  }
}

TEST(Models, SurviveDamage) {
  SKIP_WITHOUT_MODELS();
  Random random(11);
  for (const char* name : {"hand_recrop.tflite", "selfie_segmentation.tflite"}) {
    const std::vector<char> valid = read_file(fs::path(TELEMIME_BUILD_MODELS) / name);
    // The structure lies at both ends of these files, the weights between.
    constexpr std::uint32_t kEnd = 30000;
    constexpr int kRounds = 150;
    for (int round = 0; round < kRounds; ++round) {
      std::vector<char> damaged = valid;
      for (int change = 0; change < 3; ++change) {
        const std::uint32_t place = random.below(2 * kEnd);
        damaged[place < kEnd ? place : damaged.size() - 1 - (place - kEnd)] =
            static_cast<char>(random.below(256));
      }
      try {
        const Network network(std::as_bytes(std::span(damaged)));
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::config) << name << ", round " << round;
      }
    }
  }
}

}  // namespace
}  // namespace telemime
