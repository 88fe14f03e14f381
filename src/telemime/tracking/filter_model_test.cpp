// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/filter_model.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "telemime/core/scratch_folder.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

using Json = nlohmann::ordered_json;

Json default_json() {
  return Json::parse(to_json_text(load_filter_model(""), "a note"));
}

// The message of the error that this text gives.
std::string complaint(const std::string& text) {
  return testing_errors::message_of(ErrorKind::config, [&] { parse_filter_model(text, "numbers.json"); });
}

// JSON pointers of all numbers in the file.
std::vector<Json::json_pointer> all_numbers() {
  std::vector<Json::json_pointer> places;
  const Json flat = default_json().flatten();
  for (const auto& [place, value] : flat.items()) {
    if (value.is_number()) {
      places.emplace_back(place);
    }
  }
  return places;
}

bool names(const std::string& message, const std::string& key) {
  return testing_errors::names(message, "numbers.json") && testing_errors::names(message, "'" + key + "'");
}

TEST(FilterModel, TheBuiltInNumbersAreThere) {
  const FilterModel model = load_filter_model("");
  EXPECT_TRUE((model.change.array() > 0.0).all());
  EXPECT_LT(model.change.tail<kAngleCount>().maxCoeff(), 0.5) << "rad from one frame to the next";
  EXPECT_LT(model.change.head<3>().maxCoeff(), 0.05) << "m from one frame to the next";
  EXPECT_GT(model.sigma[cue::kRegion], 0.0);
  EXPECT_LT(model.sigma[cue::kRegion], 0.5);
  EXPECT_EQ(model.wrist_across, 0.070) << "thesis 4.4.2.3";
  EXPECT_EQ(model.wrist_along, 0.150) << "thesis 4.4.2.3";
  EXPECT_GT(model.spread.size, model.spread.size_given);
}

TEST(FilterModel, ReadsBackWhatItWrote) {
  FilterModel model;
  model.sigma[cue::kRegion] = 0.0123;
  model.sigma[cue::kContour] = 0.0045;
  model.sigma[cue::kLandmarks] = 0.12;
  model.sigma[cue::kBones] = 0.34;
  for (Eigen::Index i = 0; i < model.change.size(); ++i) {
    model.change[i] = 0.001 * static_cast<double>(1 + i);
  }
  model.motion = {0.1, 0.2, 0.3, 0.4};
  model.wrist_across = 0.05;
  model.wrist_along = 0.11;
  model.swivel = 0.2;
  model.spread = {0.004, 0.2, 0.06, 0.13, 0.02, 0.11, 0.07, 0.03};
  const FilterModel read = parse_filter_model(to_json_text(model, "note"), "written");
  for (std::size_t i = 0; i < kCues.size(); ++i) {
    EXPECT_DOUBLE_EQ(read.sigma[i], model.sigma[i]) << kCues[i].name;
  }
  // Written with four digits.
  EXPECT_LT(((read.change - model.change).cwiseAbs().cwiseQuotient(model.change)).maxCoeff(), 0.6e-3);
  EXPECT_EQ(read.motion, model.motion);
  EXPECT_NEAR(read.wrist_across, model.wrist_across, 1e-12);
  EXPECT_NEAR(read.wrist_along, model.wrist_along, 1e-12);
  EXPECT_NEAR(read.swivel, model.swivel, 1e-4 * model.swivel);
  EXPECT_NEAR(read.spread.trunk, model.spread.trunk, 1e-12);
  EXPECT_DOUBLE_EQ(read.spread.lean, model.spread.lean);
  EXPECT_NEAR(read.spread.slide, model.spread.slide, 1e-12);
  EXPECT_DOUBLE_EQ(read.spread.across, model.spread.across);
  EXPECT_DOUBLE_EQ(read.spread.seen, model.spread.seen);
  EXPECT_DOUBLE_EQ(read.spread.residual, model.spread.residual);
  EXPECT_DOUBLE_EQ(read.spread.size, model.spread.size);
  EXPECT_DOUBLE_EQ(read.spread.size_given, model.spread.size_given);
  EXPECT_EQ(Json::parse(to_json_text(model, "note")).at("note"), "note");
}

TEST(FilterModel, EveryNumberCounts) {
  // A number that is changed in the file is changed in the model.
  const std::string before = to_json_text(load_filter_model(""), "");
  ASSERT_EQ(all_numbers().size(), kCues.size() + kPoseSize + kPartCount + 3 + 8);
  for (const auto& place : all_numbers()) {
    Json json = default_json();
    json[place] = 2.0 * json[place].get<double>();
    EXPECT_NE(to_json_text(parse_filter_model(json.dump(), "changed"), ""), before) << place.to_string();
  }
}

TEST(FilterModel, NamesTheNumberThatIsMissingOrWrong) {
  for (const auto& place : all_numbers()) {
    const std::string key = place.back();
    Json json = default_json();
    json[place.parent_pointer()].erase(key);
    EXPECT_TRUE(names(complaint(json.dump()), key)) << key << ": " << complaint(json.dump());
    json[place.parent_pointer()][key + "s"] = 1.0;
    EXPECT_TRUE(names(complaint(json.dump()), key)) << "misspelt";
    for (const Json& wrong :
         {Json(-1.0), Json(0.0), Json("1.0"), Json(nullptr), Json::array({1.0}), Json(true)}) {
      json = default_json();
      json[place] = wrong;
      EXPECT_TRUE(names(complaint(json.dump()), key)) << key << " " << wrong;
    }
  }
}

TEST(FilterModel, NamesAGroupThatIsMissingOrWrong) {
  for (const std::string group : {"change", "motion", "end_effector", "spread"}) {
    Json json = default_json();
    json[group] = 3;
    EXPECT_TRUE(names(complaint(json.dump()), group)) << group;
    json.erase(group);
    EXPECT_TRUE(names(complaint(json.dump()), group)) << group;
  }
}

TEST(FilterModel, OtherFilesAreRefused) {
  std::vector<std::string> texts = {"", "{", "[]", "3", "null", "{}", R"({"format": "telemime-pose"})"};
  for (const Json& no_text : {Json(1), Json(nullptr), Json::array()}) {
    Json json = default_json();
    json["format"] = no_text;
    texts.push_back(json.dump());
  }
  for (const std::string& text : texts) {
    EXPECT_TRUE(testing_errors::names(complaint(text), "numbers.json")) << text;
  }
}

TEST(FilterModel, AreReadFromAFile) {
  const telemime::ScratchFolder folder;
  const auto file = folder.path() / "mine.json";
  FilterModel model = load_filter_model("");
  model.sigma[cue::kRegion] = 0.25;
  std::ofstream(file) << to_json_text(model, "");
  EXPECT_EQ(load_filter_model(file.string()).sigma[cue::kRegion], 0.25);
  for (const auto& path : {folder.path() / "none.json", folder.path()}) {
    const std::string message =
        testing_errors::message_of(ErrorKind::config, [&] { load_filter_model(path.string()); });
    EXPECT_TRUE(testing_errors::names(message, path.string())) << message;
  }
}

}  // namespace
}  // namespace telemime
