// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <sstream>

#include "telemime/core/scratch_folder.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

using testing_errors::names;
using Json = nlohmann::json;

// The message of the Error(config) that this throws.
template <typename Action>
std::string refusal(const Action& action) {
  return testing_errors::message_of(ErrorKind::config, action);
}

std::string refusal_of(const SettingValues& values) {
  Config config;
  std::string words = refusal([&] { update(config, values); });
  EXPECT_EQ(to_json(config), to_json(Config{})) << "unchanged after a refusal";
  return words;
}

std::string refusal_of_json(const Json& json) {
  return refusal_of(flatten(json));
}

SettingValues defaults() {
  return flatten(to_json(Config{}));
}

// Another valid value of the same setting.
Json other_value(const Setting& setting) {
  const Json value = value_of(setting);
  if (setting.name == "filter.heuristics") {
    return "wd,hpm";
  }
  if (setting.name == "cues") {
    return "regions,contours";
  }
  if (value.is_string()) {
    return setting.choices.empty()            ? "other.json"
           : setting.choices.front() == value ? setting.choices.back()
                                              : setting.choices.front();
  }
  if (value.is_null()) {
    return setting.high;
  }
  if (value.is_boolean()) {
    return !value.get<bool>();
  }
  if (value.is_number_integer()) {
    return value.get<int>() + 1;
  }
  return value.get<double>() == 0.0 ? 0.015625 : 1.0078125 * value.get<double>();
}

TEST(Config, DefaultsAreValid) {
  EXPECT_NO_THROW(Config{}.validate());
}

TEST(Config, WrittenAndReadAgainIsTheSame) {
  Config config;
  config.seed = 77;
  config.budget_ms = 9.5;
  config.tracking.method = "edges";
  config.calibration.stature = 1.62;
  Config again;
  update(again, flatten(to_json(config)));
  EXPECT_EQ(to_json(again), to_json(config));
  EXPECT_EQ(again.seed, 77U);
  EXPECT_EQ(again.calibration.stature, 1.62);
  update(again, {{"budget", nullptr}});
  EXPECT_FALSE(again.budget_ms);
}

TEST(Config, EverySettingCanBeReadAlone) {
  Config shown;
  for (const Setting& setting : settings_of(shown).rows) {
    if (setting.name == "quality") {
      continue;  // it sets others
    }
    const Json changed = other_value(setting);
    ASSERT_NE(changed, value_of(setting)) << setting.name;
    Config config;
    ASSERT_NO_THROW(update(config, {{setting.name, changed}})) << setting.name << " " << changed;
    SettingValues expected = defaults();
    SettingValues now = flatten(to_json(config));
    if (changed.is_number_float()) {
      EXPECT_NEAR(now[setting.name].get<double>(), changed.get<double>(), 1e-6) << setting.name;
    } else {
      EXPECT_EQ(now[setting.name], changed) << setting.name;
    }
    expected[setting.name] = now[setting.name];
    EXPECT_EQ(now, expected) << setting.name;
  }
  EXPECT_GE(defaults().size(), 50U);
}

TEST(Config, FifteenSettingsArePublic) {
  Config config;
  const SettingTable table = settings_of(config);
  const auto is_public = [](const Setting& s) { return s.name.find('.') == std::string::npos; };
  EXPECT_EQ(std::count_if(table.rows.begin(), table.rows.end(), is_public), 15);
  EXPECT_TRUE(std::is_partitioned(table.rows.begin(), table.rows.end(), is_public))
      << "the public ones first";
  std::set<std::string> seen;
  for (const Setting& s : table.rows) {
    EXPECT_TRUE(seen.insert(s.name).second) << s.name << " twice";
    EXPECT_TRUE(s.meaning.ends_with('.')) << s.name;
  }
}

TEST(Config, TheDocumentHoldsTheWholeTable) {
  std::ifstream file(std::filesystem::path(TELEMIME_SOURCE_DIR) / "docs/configuration.md");
  const std::string page(std::istreambuf_iterator<char>(file), {});
  Config config;
  EXPECT_TRUE(names(page, explain(settings_of(config))))
      << "docs/configuration.md must hold the output of `telemime config --explain`";
  // And a table of the settings that `quality` presets: their names and three values.
  std::array<SettingValues, 3> of_quality;
  for (std::size_t i = 0; i < of_quality.size(); ++i) {
    update(config, {{"quality", std::array{"fast", "balanced", "best"}[i]}});
    of_quality[i] = flatten(to_json(config));
  }
  std::set<std::string> expected;
  for (const auto& [name, fast] : of_quality[0]) {
    const Json& balanced = of_quality[1].at(name);
    const Json& best = of_quality[2].at(name);
    if (name != "quality" && (fast != balanced || best != balanced)) {
      expected.insert("| `" + name + "` | " + fast.dump() + " | " + balanced.dump() + " | " + best.dump() +
                      " |");
    }
  }
  const std::string head = "| setting | fast | balanced | best |\n| --- | --- | --- | --- |\n";
  ASSERT_NE(page.find(head), std::string::npos);
  std::istringstream rows(page.substr(page.find(head) + head.size()));
  std::set<std::string> written;
  for (std::string row; std::getline(rows, row) && !row.empty();) {
    written.insert(row);
  }
  EXPECT_EQ(written, expected);
}

TEST(Config, QualityPresetsWhatIsNotGiven) {
  Config config;
  update(config, {{"quality", "balanced"}});
  EXPECT_EQ(to_json(config), to_json(Config{})) << "balanced is the default";
  update(config, {{"quality", "fast"}, {"particles", 123}});
  EXPECT_EQ(config.filter.particles, 123);
  EXPECT_LT(config.registration.iterations, Config{}.registration.iterations);
  update(config, {{"quality", "best"}});
  EXPECT_GT(config.filter.particles, Config{}.filter.particles);
  update(config, {{"quality", "balanced"}});
  EXPECT_EQ(to_json(config), to_json(Config{})) << "nothing of the others is left";
}

TEST(Config, CondensationIsTheFilterOfTheThesis) {
  Config config;
  EXPECT_EQ(to_json(resolved(config)), to_json(config));
  config.tracking.method = "condensation";
  config.filter.particles = 321;
  config.filter.diffusion = 2.0;
  config.filter.estimate = "mean";
  config.filter.model = "numbers.json";
  const FilterConfig filter = resolved(config).filter;
  EXPECT_EQ(filter.heuristics, "");
  EXPECT_EQ(filter.trust, 1.0);
  EXPECT_EQ(filter.particles, 321);
  EXPECT_EQ(filter.diffusion, 2.0);
  EXPECT_EQ(filter.estimate, "mean");
  EXPECT_EQ(filter.model, "numbers.json");
}

TEST(Config, MethodChoosesTheStepsOfTheSearch) {
  Config config;
  for (const auto& [name, method] : kMethodNames) {
    config.tracking.method = name;
    EXPECT_FALSE(uses_filter(config));
    EXPECT_EQ(resolved(config).registration.method, method);
  }
}

TEST(Config, WrongTypeIsRefusedWithTheKeysName) {
  for (const auto& [name, value] : defaults()) {
    for (const Json& wrong : {Json::array(), Json({1, 2})}) {
      EXPECT_TRUE(names(refusal_of({{name, wrong}}), "'" + name + "'")) << name << " " << wrong;
    }
    EXPECT_TRUE(names(refusal_of({{name + ".deeper", 1}}), "'" + name + ".deeper'")) << name;
    EXPECT_TRUE(names(refusal_of({{name, value.is_string() ? Json(3) : Json("words")}}), "'" + name + "'"));
    if (value.is_number()) {
      EXPECT_TRUE(names(refusal_of({{name, true}}), "'" + name + "'"));
      EXPECT_TRUE(names(refusal_of({{name, nullptr}}), "'" + name + "'"));
    }
    if (value.is_number_integer()) {
      EXPECT_TRUE(names(refusal_of({{name, 1.5}}), "'" + name + "'"));
      EXPECT_TRUE(names(refusal_of({{name, -1e15}}), "'" + name + "'"));
      EXPECT_TRUE(names(refusal_of({{name, -10'000'000'000}}), "'" + name + "'"));
    }
  }
}

TEST(Config, NumbersThatAreNotFiniteAreRefused) {
  int numbers = 0;
  for (const auto& [name, value] : defaults()) {
    if (!value.is_number_float()) {
      continue;
    }
    ++numbers;
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      EXPECT_TRUE(names(refusal_of({{name, bad}}), "'" + name + "'"));
    }
  }
  EXPECT_GE(numbers, 20);
}

TEST(Config, UnknownKeysAreRefusedByName) {
  const std::pair<Json, std::string> unknown[] = {
      {{{"sede", 1}}, "sede"},
      {{{"registration", {{"iteration", 5}}}}, "registration.iteration"},
      {{{"registration", 5}}, "registration"},
      {{{"image/width", 160}}, "image/width"},
      {{{"nothing", Json::object()}}, "nothing"},
      {{{"image", {{"edges", {{"beta", 1}}}}}}, "image.edges.beta"},
      {{{"seed", 5}, {"zzz", nullptr}}, "zzz"},
  };
  for (const auto& [json, name] : unknown) {
    EXPECT_TRUE(names(refusal_of_json(json), "'" + name + "'")) << json << ": " << refusal_of_json(json);
  }
  Config config;
  EXPECT_NO_THROW(update(config, flatten({{"image", Json::object()}, {"registration", Json::object()}})));
}

TEST(Config, OldAndMisspeltNamesGetTheNearestOne) {
  const std::pair<std::string, std::string> names_of[] = {
      {"sede", "seed"},
      {"filter.particles", "particles"},
      {"registration.iteration", "registration.iterations"},
      {"offline.stretch", "trajectory.stretch"},
      {"smoothing.look_ahead", "smoother.look_ahead"}};
  for (const auto& [old, now] : names_of) {
    EXPECT_TRUE(names(refusal_of({{old, 1}}), "'" + now + "'")) << refusal_of({{old, 1}});
  }
}

TEST(Config, TheFuzzersSeedIsAWholeConfiguration) {
  // A seed that is refused at its first key would leave the reader behind it untried.
  Config config;
  update(config,
         read_settings(std::filesystem::path(TELEMIME_SOURCE_DIR) / "fuzz/corpus/config/default.json"));
  EXPECT_EQ(to_json(config), to_json(Config{}));
}

TEST(Config, WhatIsNoObjectIsRefused) {
  for (const Json& json : {Json(), Json(3), Json::array({1}), Json("seed")}) {
    EXPECT_TRUE(names(refusal([&] { flatten(json); }), "object")) << json;
  }
}

TEST(Config, ValuesOutOfRangeAreRefusedByName) {
  const std::pair<std::string, Json> faults[] = {{"fov", 0.0},
                                                 {"fov", 180.0},
                                                 {"quality", "worst"},
                                                 {"backend", "abacus"},
                                                 {"budget", 0.0},
                                                 {"tracking.lost_region", 0.0},
                                                 {"tracking.found_region", 1.5},
                                                 {"tracking.patience", 0},
                                                 {"tracking.velocity", -0.1},
                                                 {"registration.iterations", 0},
                                                 {"registration.proposal_share", 1.1},
                                                 {"registration.proposals.kept", 0},
                                                 {"registration.proposals.refine", 10001},
                                                 {"registration.proposals.margin", -0.1},
                                                 {"registration.edge_step.trunk", -1.0},
                                                 {"method", "guess"},
                                                 {"particles", 0},
                                                 {"filter.heuristics", "magic"},
                                                 {"filter.estimate", "median"},
                                                 {"filter.trust", 0.0},
                                                 {"filter.mode_least", 5000},
                                                 {"threads", -1},
                                                 {"image.width", 3},
                                                 {"calibration.worst_region", -1.0},
                                                 {"smoothing", "magic"},
                                                 {"height", 17.2},
                                                 {"seed", -1}};
  for (const auto& [name, value] : faults) {
    EXPECT_TRUE(names(refusal_of({{name, value}}), name)) << name << " " << value;
  }
}

class ConfigFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& bytes) const {
    auto file = folder_ / "config.json";
    std::ofstream(file) << bytes;
    return file;
  }
  static std::string refusal_of_file(const std::filesystem::path& file) {
    Config config;
    return refusal([&] { update(config, read_settings(file)); });
  }
  ScratchFolder scratch_;
  std::filesystem::path folder_ = scratch_.path();
};

TEST_F(ConfigFile, IsReadWithComments) {
  Config config;
  update(config, read_settings(write("{ // why\n \"seed\": 5, \"registration\": {\"iterations\": 200} }")));
  EXPECT_EQ(config.seed, 5U);
  EXPECT_EQ(config.registration.iterations, 200);
}

TEST_F(ConfigFile, MissingFilesAndFoldersAreNamed) {
  for (const auto& file : {folder_ / "missing.json", folder_}) {
    EXPECT_TRUE(names(refusal_of_file(file), file.string())) << refusal_of_file(file);
  }
}

TEST_F(ConfigFile, BrokenJsonAndNaNAreNamed) {
  for (const char* bytes : {"", "{", "{\"seed\": NaN}", "{\"registration\": {\"edge_factor\": 1e999}}",
                            "{\"fov\": Infinity}", "\xff\xfe\x00"}) {
    const std::string words = refusal_of_file(write(bytes));
    EXPECT_TRUE(names(words, "config.json") && names(words, "JSON")) << bytes << ": " << words;
  }
}

}  // namespace
}  // namespace telemime
