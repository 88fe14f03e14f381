// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/limits.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "telemime/body/testing_poses.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

using testing_poses::kDegree;

const JointLimits kSets[] = {reference_limits(), anatomical_limits()};

TEST(Limits, ReferenceIsTableTwoOneOfTheThesis) {
  constexpr int kTable[kAngleCount][2] = {{-180, 180}, {-45, 45},  {-45, 45}, {-10, 10},   {-10, 10},
                                          {-10, 10},   {-110, 25}, {-60, 30}, {-20, 100},  {-110, 25},
                                          {-30, 60},   {-100, 20}, {-150, 0}, {-150, 0},   {-20, 20},
                                          {-100, 100}, {-37, 27},  {-20, 20}, {-100, 100}, {-37, 27}};
  const JointLimits limits = reference_limits();
  for (std::size_t i = 0; i < kAngleCount; ++i) {
    EXPECT_NEAR(limits.min[i] / kDegree, kTable[i][0], 1e-9) << kAngleNames[i];
    EXPECT_NEAR(limits.max[i] / kDegree, kTable[i][1], 1e-9) << kAngleNames[i];
  }
}

TEST(Limits, SetsHaveNamesRoomAndTheRestPose) {
  EXPECT_EQ(reference_limits().name, "reference");
  EXPECT_EQ(anatomical_limits().name, "anatomical");
  for (const JointLimits& limits : kSets) {
    EXPECT_TRUE(limits.contains(Pose{})) << limits.name;
    for (std::size_t i = 0; i < kAngleCount; ++i) {
      EXPECT_LT(limits.min[i], limits.max[i]) << limits.name << " " << kAngleNames[i];
    }
  }
}

TEST(Limits, AnatomicalReachesAboveTheHeadAndReferenceDoesNot) {
  Pose up;
  up[Angle::l_shoulder_flexion] = -170 * kDegree;
  EXPECT_TRUE(anatomical_limits().contains(up));
  EXPECT_FALSE(reference_limits().contains(up));
}

TEST(Limits, ContainsIsTrueExactlyInsideEachRange) {
  for (const JointLimits& limits : kSets) {
    for (std::size_t i = 0; i < kAngleCount; ++i) {
      Pose pose;
      const auto at = [&](double value) {
        pose.angles[i] = value;
        return limits.contains(pose);
      };
      EXPECT_TRUE(at(limits.min[i]) && at(limits.max[i])) << limits.name << " " << kAngleNames[i];
      EXPECT_FALSE(at(limits.min[i] - 0.01)) << limits.name << " " << kAngleNames[i];
      EXPECT_FALSE(at(limits.max[i] + 0.01)) << limits.name << " " << kAngleNames[i];
      EXPECT_FALSE(at(std::nan(""))) << limits.name << " " << kAngleNames[i];
    }
  }
}

TEST(Limits, LeftAndRightAreMirrorImages) {
  for (const JointLimits& limits : kSets) {
    for (std::size_t i = 0; i < kAngleCount; ++i) {
      for (const double value : {limits.min[i] - 0.01, limits.min[i], 0.5 * (limits.min[i] + limits.max[i]),
                                 limits.max[i], limits.max[i] + 0.01}) {
        Pose pose;
        pose.angles[i] = value;
        EXPECT_EQ(limits.contains(pose), limits.contains(mirrored(pose)))
            << limits.name << " " << kAngleNames[i] << " " << value / kDegree;
      }
    }
  }
}

TEST(Limits, ClampMovesOnlyWhatIsOutside) {
  Random random(1);
  for (const JointLimits& limits : kSets) {
    for (int n = 0; n < 200; ++n) {
      Pose pose;
      pose.root = {3, -2, 9};
      for (double& angle : pose.angles) {
        angle = random.uniform(-4.0, 4.0);
      }
      const Pose inside = limits.clamp(pose);
      ASSERT_TRUE(limits.contains(inside, 0.0));
      ASSERT_EQ(inside.root, pose.root);
      for (std::size_t i = 0; i < kAngleCount; ++i) {
        const bool was_inside = pose.angles[i] >= limits.min[i] && pose.angles[i] <= limits.max[i];
        ASSERT_EQ(inside.angles[i] == pose.angles[i], was_inside);
      }
      ASSERT_EQ(limits.clamp(inside).vector(), inside.vector());
    }
  }
}

class LimitsFile : public ::testing::Test {
 protected:
  LimitsFile() {
    json_["name"] = "mine";
    for (const std::string_view name_of_angle : kAngleNames) {
      json_["limits"][std::string(name_of_angle)] = {-30, 60.5};
    }
  }

  std::string write(const std::string& bytes) const {
    const auto file = folder_ / "limits.json";
    std::ofstream(file) << bytes;
    return file.string();
  }

  // The message of the Error(config) that reading these bytes gives.
  std::string refusal(const std::string& bytes) const {
    const std::string file = write(bytes);
    const std::string message = testing_errors::message_of(ErrorKind::config, [&] { load_limits(file); });
    EXPECT_TRUE(testing_errors::names(message, file)) << message;
    return message;
  }
  std::string refusal() const { return refusal(json_.dump()); }

  ScratchFolder scratch_;
  std::filesystem::path folder_ = scratch_.path();
  nlohmann::json json_;
};

TEST_F(LimitsFile, HoldsDegrees) {
  json_["limits"]["l_elbow_flexion"] = {-120, 0};
  const JointLimits limits = load_limits(write(json_.dump()));
  EXPECT_EQ(limits.name, "mine");
  const auto elbow = static_cast<std::size_t>(Angle::l_elbow_flexion);
  EXPECT_NEAR(limits.min[elbow], -120 * kDegree, 1e-12);
  EXPECT_NEAR(limits.max[elbow], 0.0, 1e-12);
  EXPECT_NEAR(limits.max[0], 60.5 * kDegree, 1e-12);
}

TEST_F(LimitsFile, NamesOfSetsNeedNoFile) {
  EXPECT_EQ(load_limits("reference").min, reference_limits().min);
  EXPECT_EQ(load_limits("anatomical").max, anatomical_limits().max);
}

TEST_F(LimitsFile, RefusesWhatIsNoFile) {
  const std::string message = testing_errors::message_of(
      ErrorKind::config, [&] { load_limits((folder_ / "missing.json").string()); });
  EXPECT_TRUE(testing_errors::names(message, "missing.json")) << message;
  EXPECT_TRUE(testing_errors::names(message, "anatomical")) << "no remedy: " << message;
  EXPECT_THROW(load_limits(folder_.string()), Error);
}

TEST_F(LimitsFile, RefusesWhatIsNoTableOfLimits) {
  for (const char* bytes : {"", "not json", "[1, 2]", "{}", R"({"limits": [1]})", R"({"limits": 3)"}) {
    EXPECT_NE(refusal(bytes).find("'limits'"), std::string::npos) << bytes << ": " << refusal(bytes);
  }
}

TEST_F(LimitsFile, NamesTheAngleThatIsWrong) {
  const nlohmann::json good = json_;
  json_["limits"]["l_knee"] = {0, 1};
  EXPECT_NE(refusal().find("'l_knee'"), std::string::npos) << refusal();
  json_ = good;
  json_["limits"].erase("neck_tilt");
  EXPECT_NE(refusal().find("'neck_tilt'"), std::string::npos) << refusal();
  for (const auto& value :
       {nlohmann::json(3), nlohmann::json({1, 2, 3}), nlohmann::json({"a", 2}), nlohmann::json({1, nullptr}),
        nlohmann::json({10, -10}), nlohmann::json({-1000, 10}), nlohmann::json({-10, 1e300})}) {
    json_ = good;
    json_["limits"]["r_wrist_pivot"] = value;
    EXPECT_NE(refusal().find("'r_wrist_pivot'"), std::string::npos) << value << ": " << refusal();
  }
}

}  // namespace
}  // namespace telemime
