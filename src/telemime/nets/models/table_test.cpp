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
// computes from bright_ellipse(): mean, root mean square, and five elements from the first to the last.
struct GoldenOutput {
  std::string_view model;
  std::string_view output;
  double mean;
  double rms;
  std::array<double, 5> samples;
};
constexpr GoldenOutput kGolden[] = {
#include "telemime/nets/models/testing_golden.inc"
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
  const std::vector<std::string> names = {"hand_recrop", "face_landmark_with_attention"};
  std::ofstream(folder.file("hand_recrop.tflite")) << "x";
  const std::string missing = missing_models(folder.path(), names);
  EXPECT_EQ(missing.find("hand_recrop"), std::string::npos);
  EXPECT_NE(missing.find("there is no face_landmark_with_attention.tflite in " + folder.path().string()),
            std::string::npos);
  EXPECT_NE(missing.find("TELEMIME_MODELS"), std::string::npos);
  EXPECT_NE(missing_models({}, names), "");
  EXPECT_THROW(load_network(folder.path(), "face_landmark_with_attention"), Error);
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
    Network network = load_network(TELEMIME_BUILD_MODELS, model.name, {.inputs = {}, .outputs = names});
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
  for (const char* name : {"hand_recrop.tflite", "face_detection_short_range.tflite"}) {
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
