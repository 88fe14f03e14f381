// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/truth.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

using nlohmann::json;

json small_truth() {
  return json::parse(R"({
    "fps": 20, "width": 640, "height": 480, "fx": 500, "fy": 510, "cx": 319.5, "cy": 239.5,
    "joints": ["l_wrist", "l_knee", "root"],
    "positions": [[[1, 2, 1000], [4, 5, 6], [7, 8, 9]], [null, [4, 5, 6], [7, 8, 9]]]
  })");
}

TEST(Truth, ReadsMetresByName) {
  const Truth truth = parse_truth(small_truth().dump(), "t");
  ASSERT_EQ(truth.frames.size(), 2U);
  const auto& wrist = truth.frames[0][static_cast<std::size_t>(Joint::l_wrist)];
  ASSERT_TRUE(wrist);
  EXPECT_TRUE(wrist->isApprox(Eigen::Vector3d(0.001, 0.002, 1.0)));
  EXPECT_TRUE(truth.frames[0][static_cast<std::size_t>(Joint::root)]);
  EXPECT_FALSE(truth.frames[0][static_cast<std::size_t>(Joint::r_wrist)]);
  EXPECT_FALSE(truth.frames[1][static_cast<std::size_t>(Joint::l_wrist)]);
  EXPECT_DOUBLE_EQ(truth.fps, 20.0);
  EXPECT_TRUE(truth.scale_known);
  EXPECT_TRUE(truth.is_scored(1));
}

TEST(Truth, FlagsRangeAndScale) {
  json root = small_truth();
  root["valid"] = {{0, 1, 1}, {1, 1, 0}};
  root["visible"] = {true, false};
  root["best_frames"] = {0, 5};
  root["scale"] = "unknown within about 20 %";
  const Truth truth = parse_truth(root.dump(), "t");
  EXPECT_FALSE(truth.frames[0][static_cast<std::size_t>(Joint::l_wrist)]);
  EXPECT_TRUE(truth.frames[0][static_cast<std::size_t>(Joint::root)]);
  EXPECT_FALSE(truth.frames[1][static_cast<std::size_t>(Joint::root)]);
  EXPECT_TRUE(truth.is_scored(0));
  EXPECT_FALSE(truth.is_scored(1));
  EXPECT_FALSE(truth.scale_known);
}

TEST(Truth, ReadsTheHeadOrThatItIsUnknown) {
  json root = small_truth();
  EXPECT_TRUE(parse_truth(root.dump(), "t").heads.empty());
  root["head"] = {{0.6, 0.0, 0.0, 0.8}, nullptr};
  const Truth truth = parse_truth(root.dump(), "t");
  ASSERT_EQ(truth.heads.size(), 2U);
  EXPECT_TRUE(truth.heads[0]->isApprox(Eigen::Quaterniond(0.8, 0.6, 0.0, 0.0)));
  EXPECT_FALSE(truth.heads[1]);
  root["head"][1] = {0.0, 0.0, 0.0, 2.0};
  EXPECT_THROW(parse_truth(root.dump(), "t"), Error);
  root["head"] = {nullptr};
  EXPECT_THROW(parse_truth(root.dump(), "t"), Error);
}

TEST(Truth, SaysWhatIsWrong) {
  const auto broken = [](const std::string& key, const json& value) {
    json root = small_truth();
    root[key] = value;
    return root.dump();
  };
  EXPECT_THROW(parse_truth("", "t"), Error);
  EXPECT_THROW(parse_truth("[]", "t"), Error);
  EXPECT_THROW(parse_truth(broken("fx", 0), "t"), Error);
  EXPECT_THROW(parse_truth(broken("fps", "25"), "t"), Error);
  EXPECT_THROW(parse_truth(broken("joints", {1, 2, 3}), "t"), Error);
  EXPECT_THROW(parse_truth(broken("positions", json::array()), "t"), Error);
  EXPECT_THROW(parse_truth(broken("positions", {{{1, 2, 3}}}), "t"), Error);
  EXPECT_THROW(parse_truth(broken("visible", {true}), "t"), Error);
  EXPECT_THROW(parse_truth(broken("best_frames", {3, 1}), "t"), Error);
  EXPECT_THROW(parse_truth(broken("valid", {{1, 1, 1}}), "t"), Error);
  EXPECT_THROW(parse_truth(small_truth().dump().substr(0, 100), "t"), Error);
  EXPECT_THROW(read_truth("/nonexistent/truth.json"), Error);
}

TEST(Truth, ReadsTheSharedClips) {
  const char* const variable = std::getenv("TELEMIME_DATA");
  const std::filesystem::path data = variable != nullptr ? variable : TELEMIME_SOURCE_DIR "/../shared/data";
  if (!std::filesystem::exists(data / "dev")) {
    const std::string reason = "no test data: set TELEMIME_DATA";
    std::cout << reason << '\n';
    GTEST_SKIP() << reason;
  }
  const Truth arms = read_truth(data / "dev/raising_arms/truth.json");
  EXPECT_EQ(arms.frames.size(), 165U);
  EXPECT_TRUE(arms.scale_known);
  const Truth walk = read_truth(data / "dev_practical/enter_leave/truth.json");
  EXPECT_FALSE(walk.is_scored(37));
  EXPECT_TRUE(walk.is_scored(38));
  EXPECT_FALSE(walk.is_scored(222));
  const Truth seated = read_truth(data / "real/seated_stereo/truth.json");
  EXPECT_FALSE(seated.scale_known);
  EXPECT_EQ(seated.first_scored, 35U);
  EXPECT_EQ(seated.last_scored, 164U);
  EXPECT_FALSE(seated.frames[0][static_cast<std::size_t>(Joint::r_wrist)]);
}

}  // namespace
}  // namespace telemime
