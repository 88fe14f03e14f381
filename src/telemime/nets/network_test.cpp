// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"
#include "telemime/nets/testing_network_file.h"

namespace telemime {
namespace {

using testing_network_file::FileNode;
using testing_network_file::FileTensor;
using testing_network_file::network_file;
using testing_network_file::Option;

constexpr int kAdd = 0, kConcatenation = 2, kConvolution = 3, kDequantize = 6, kMaxPool = 17, kReshape = 22;
constexpr int kPad = 34, kSlice = 45, kDensify = 124;
constexpr int kSame = 0, kValid = 1;

// Padding, strides and activation of a convolution.
std::vector<Option> convolution(int padding, int stride, int activation = 0) {
  return {{0, padding}, {1, stride, true}, {2, stride, true}, {3, activation}};
}

std::vector<float> computed(const std::vector<std::byte>& file, const std::vector<float>& input) {
  Network network(file);
  const auto outputs = network.run(input);
  return {outputs[0].begin(), outputs[0].end()};
}

std::string refusal(const std::vector<std::byte>& file) {
  try {
    const Network network(file);
  } catch (const Error& error) {
    return error.kind() == ErrorKind::config ? error.what() : "another kind of error";
  }
  return "accepted";
}

// Two 3 x 3 windows of ones on a padded image, halved to a pool and joined: one file with most features.
std::vector<std::byte> rich_file() {
  return network_file(
      {{{1, 4, 4, 1}},
       {{4, 2}, {}, {0, 0, 1, 1, 1, 1, 0, 0}},
       {{1, 6, 6, 1}},
       {{2, 3, 3, 1}, std::vector<float>(18, 1.0F), {}, true},
       {{2, 3, 3, 1}},
       {{2}, {0.0F, 1.0F}},
       {{1, 4, 4, 2}},
       {{1, 2, 2, 2}},
       {{1, 4, 2}},
       {{1, 8, 1}},
       {{1, 8, 1}},
       {{1, 16, 1}}},
      {{kPad, {0, 1}, 2},
       {kDequantize, {3}, 4},
       {kConvolution, {2, 4, 5}, 6, convolution(kValid, 1)},
       {kMaxPool, {6}, 7, {{0, kValid}, {1, 2, true}, {2, 2, true}, {3, 2, true}, {4, 2, true}}},
       {kReshape, {7}, 8},
       {kReshape, {7}, 9},
       {kReshape, {7}, 10},
       {kConcatenation, {9, 10}, 11, {{0, 1, true}}}},
      {11, 8});
}

TEST(Network, ConvolutionByHand) {
  const auto file =
      network_file({{{1, 1, 2, 2}}, {{2, 1, 1, 2}, {1, 2, 3, 4}}, {{2}, {0.5F, -40.0F}}, {{1, 1, 2, 2}}},
                   {{kConvolution, {0, 1, 2}, 3, convolution(kSame, 1, 1)}}, {3});
  EXPECT_EQ(computed(file, {1, 2, 10, 20}), (std::vector<float>{5.5F, 0.0F, 50.5F, 70.0F}));
}

TEST(Network, SamePaddingWithStrideByHand) {
  const auto file =
      network_file({{{1, 4, 4, 1}}, {{1, 3, 3, 1}, std::vector<float>(9, 1.0F)}, {{1, 2, 2, 1}}},
                   {{kConvolution, {0, 1}, 2, convolution(kSame, 2)}}, {2});
  std::vector<float> image(16);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image[i] = static_cast<float>(i);
  }
  // TensorFlow pads the bottom and the right alone here: the first window begins at the first pixel.
  EXPECT_EQ(computed(file, image), (std::vector<float>{45, 39, 66, 50}));
}

TEST(Network, PaddingPoolAndConcatenationByHand) {
  Network network(rich_file());
  const auto outputs = network.run(std::vector<float>(16, 1.0F));
  // Ones everywhere: each window that touches no border counts 9, and each pool holds such a window.
  const std::vector<float> expected = {9, 10, 9, 10, 9, 10, 9, 10, 9, 10, 9, 10, 9, 10, 9, 10};
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), outputs[0].begin(), outputs[0].end()));
  EXPECT_TRUE(std::equal(expected.begin(), expected.begin() + 8, outputs[1].begin(), outputs[1].end()));
}

TEST(Network, SparseWeightsByHand) {
  const FileTensor weights{
      .shape = {2, 1, 1, 3}, .values = {5, 7}, .half = true, .row_starts = {0, 1, 2}, .columns = {2, 0}};
  const auto file = network_file(
      {{{1, 1, 1, 3}}, weights, {{2, 1, 1, 3}}, {{2, 1, 1, 3}}, {{1, 1, 1, 2}}},
      {{kDensify, {1}, 2}, {kDequantize, {2}, 3}, {kConvolution, {0, 3}, 4, convolution(kSame, 1)}}, {4});
  EXPECT_EQ(computed(file, {1, 10, 100}), (std::vector<float>{500, 7}));
}

TEST(Network, SliceKeepsTheFirstChannels) {
  const auto file = network_file({{{1, 1, 2, 3}},
                                  {{4}, {}, {0, 0, 0, 0}},
                                  {{4}, {}, {0, 0, 0, 2}},
                                  {{4}, {}, {1, 1, 1, 1}},
                                  {{1, 1, 2, 2}}},
                                 {{kSlice, {0, 1, 2, 3}, 4}}, {4});
  EXPECT_EQ(computed(file, {1, 2, 3, 4, 5, 6}), (std::vector<float>{1, 2, 4, 5}));
}

TEST(Network, ComputesNamedOutputsOnly) {
  const std::vector<std::string> names = {"t8"};
  Network network(rich_file(), {.inputs = {}, .outputs = names});
  const auto outputs = network.run(std::vector<float>(16, 1.0F));
  ASSERT_EQ(outputs.size(), 1U);
  EXPECT_EQ(outputs[0].size(), 8U);
  const std::vector<std::string> unknown = {"t1"};
  EXPECT_THROW(Network(rich_file(), {.inputs = {}, .outputs = unknown}), Error);
}

TEST(Network, ComputesFromAnInnerTensor) {
  // What comes before the given tensor is not read: an operator that is not supported does not matter there.
  const auto file = network_file({{{1, 2}}, {{1, 1, 2, 1}}, {{1, 1, 2, 1}}, {{1, 1, 2, 1}}},
                                 {{99, {0}, 1}, {kAdd, {1, 1}, 2}, {kAdd, {2, 1}, 3}}, {3});
  Network network(file, {.inputs = {"t1"}, .outputs = {"t2", "t3"}});
  const auto outputs = network.run(std::vector<float>{1, 10});
  EXPECT_EQ(std::vector<float>(outputs[0].begin(), outputs[0].end()), (std::vector<float>{2, 20}));
  EXPECT_EQ(std::vector<float>(outputs[1].begin(), outputs[1].end()), (std::vector<float>{3, 30}));
  EXPECT_THROW(Network(file, {.inputs = {"t0"}, .outputs = {}}), Error);
  EXPECT_THROW(Network(file, {.inputs = {"t9"}, .outputs = {}}), Error);
}

TEST(Network, ComputesFromTwoInnerTensors) {
  const auto file = network_file({{{1, 2}}, {{1, 2}}, {{1, 2}}, {{1, 2}}},
                                 {{kAdd, {0, 0}, 1}, {kAdd, {1, 0}, 2}, {kAdd, {1, 2}, 3}}, {3});
  Network network(file, {.inputs = {"t2", "t1"}, .outputs = {}});
  const std::vector<float> second = {1, 2};
  const std::vector<float> first = {30, 40};
  const std::vector<std::span<const float>> inputs = {first, second};
  const auto outputs = network.run(inputs);
  EXPECT_EQ(std::vector<float>(outputs[0].begin(), outputs[0].end()), (std::vector<float>{31, 42}));
  EXPECT_THROW(network.run(first), Error);
}

TEST(Network, KeepsSomeRowsOfAnImage) {
  // Windows of 3 x 3 ones on eight rows of two pixels: a row counts itself and its neighbours.
  const auto file =
      network_file({{{1, 8, 2, 1}}, {{1, 3, 3, 1}, std::vector<float>(9, 1.0F)}, {{1, 8, 2, 1}}},
                   {{kConvolution, {0, 1}, 2, convolution(kSame, 1)}}, {2});
  Network network(file, {.inputs = {}, .outputs = {}, .rows = {.bands = 2, .parts = 4}});
  EXPECT_EQ(network.input_shape(), (TensorShape{1, 4, 2, 1}));
  const auto outputs = network.run(std::vector<float>{1, 1, 10, 10, 100, 100, 1000, 1000});
  // The first row lacks its upper neighbour, and the last is at the end of the image.
  EXPECT_EQ(std::vector<float>(outputs[0].begin(), outputs[0].end()),
            (std::vector<float>{22, 22, 222, 222, 2220, 2220, 2200, 2200}));
  EXPECT_THROW(Network(file, {.inputs = {}, .outputs = {}, .rows = {.bands = 1, .parts = 3}}), Error);
  for (const RowShare& none : {RowShare{0, 4}, RowShare{5, 4}, RowShare{1, 0}}) {
    EXPECT_THROW(Network(file, {.inputs = {}, .outputs = {}, .rows = none}), Error);
  }
  EXPECT_THROW(Network(rich_file(), {.inputs = {}, .outputs = {}, .rows = {.bands = 1, .parts = 2}}), Error);
  const auto vectors = network_file({{{1, 2}}, {{1, 2}}}, {{kAdd, {0, 0}, 1}}, {1});
  EXPECT_THROW(Network(vectors, {.inputs = {}, .outputs = {}, .rows = {.bands = 1, .parts = 2}}), Error);
}

TEST(Network, RefusesInputOfAnotherSize) {
  Network network(rich_file());
  EXPECT_THROW(network.run(std::vector<float>(15)), Error);
}

TEST(Network, RefusesUnknownOperator) {
  const auto file = network_file({{{1, 2}}, {{1, 2}}}, {{99, {0}, 1}}, {1});
  EXPECT_NE(refusal(file).find("operator 99 is not supported"), std::string::npos);
}

TEST(Network, RefusesShapesThatDoNotFit) {
  const auto sum = [](const std::vector<int>& shape) {
    return network_file({{{1, 2, 2, 1}}, {shape}}, {{kAdd, {0, 0}, 1}}, {1});
  };
  EXPECT_EQ(refusal(sum({1, 2, 2, 1})), "accepted");
  EXPECT_NE(refusal(sum({1, 2, 2, 2})).find("does not follow from its inputs"), std::string::npos);
  EXPECT_NE(refusal(sum({1 << 20, 1 << 20})).find("too large"), std::string::npos);
  EXPECT_NE(refusal(sum({1, -2, -2, 1})).find("no usable size"), std::string::npos);
}

TEST(Network, RefusesWeightsThatDoNotFit) {
  const auto file = [](const std::vector<int>& weights, std::size_t values) {
    return network_file({{{1, 2, 2, 2}}, {weights, std::vector<float>(values, 1.0F)}, {{1, 2, 2, 1}}},
                        {{kConvolution, {0, 1}, 2, convolution(kSame, 1)}}, {2});
  };
  EXPECT_EQ(refusal(file({1, 1, 1, 2}, 2)), "accepted");
  EXPECT_NE(refusal(file({1, 1, 1, 2}, 3)).find("more or fewer numbers"), std::string::npos);
  EXPECT_NE(refusal(file({1, 1, 1, 3}, 3)).find("weights do not fit"), std::string::npos);
}

TEST(Network, RefusesOtherFiles) {
  EXPECT_NE(refusal({}).find("not a TensorFlow Lite file"), std::string::npos);
  EXPECT_NE(refusal(std::vector<std::byte>(1000)).find("not a TensorFlow Lite file"), std::string::npos);
}

TEST(Network, SurvivesDamagedFiles) {
  const std::vector<std::byte> valid = rich_file();
  for (std::size_t length = 0; length < valid.size(); ++length) {
    const std::vector<std::byte> cut(valid.begin(), valid.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_NE(refusal(cut), "another kind of error") << "cut after " << length << " bytes";
  }
  Random random(7);
  std::size_t refused = 0;
  constexpr std::size_t kRounds = 4000;
  for (std::size_t round = 0; round < kRounds; ++round) {
    std::vector<std::byte> damaged = valid;
    for (std::uint32_t change = 1 + random.below(4); change > 0; --change) {
      damaged[random.below(static_cast<std::uint32_t>(damaged.size()))] =
          static_cast<std::byte>(random.below(256));
    }
    try {
      Network network(damaged);
      network.run(std::vector<float>(element_count(network.input_shape()), 0.5F));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::config) << "round " << round;
      ++refused;
    }
  }
  EXPECT_GT(refused, kRounds / 4);
}

TEST(Network, SameInputSameBytes) {
  Network first(rich_file());
  Network second(rich_file());
  Random random(3);
  std::vector<float> image(16);
  std::generate(image.begin(), image.end(), [&] { return static_cast<float>(random.uniform()); });
  const auto a = first.run(image);
  first.run(std::vector<float>(16, 3.0F));
  first.run(image);
  const auto b = second.run(image);
  EXPECT_TRUE(std::equal(a[0].begin(), a[0].end(), b[0].begin(), b[0].end()));
}

}  // namespace
}  // namespace telemime
