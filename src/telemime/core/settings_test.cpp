// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

using Json = nlohmann::json;

struct Oven {
  bool fan = true;
  int trays = 2;
  std::uint64_t number = 7;
  float share = 0.01F;
  double heat = 180.0;
  std::optional<double> minutes;
  std::string mode = "top";
};

SettingTable settings_of(Oven& o) {
  return {{flag("fan", o.fan, "Is the fan on?"), number("trays", &o.trays, {1, 3}, "", "Trays."),
           number("number", &o.number, {0, std::numeric_limits<double>::infinity()}, "", "Its number."),
           number("rack.share", &o.share, {0, 1}, "", "Share."),
           number("rack.heat", &o.heat, {50, 250}, "degrees", "Heat."),
           number("rack.minutes", &o.minutes, {1, 90}, "min", "Time."),
           text("rack.mode", o.mode, {"top", "bottom", "both"}, "Where it heats.")},
          {{!o.fan || o.heat < 240.0, "the fan needs a rack.heat below 240"}}};
}

std::string refusal(const SettingValues& values) {
  Oven oven;
  return error_of(ErrorKind::config, [&] {
    assign(settings_of(oven), values);
    check_settings(oven);
  });
}

TEST(Settings, JsonAndBackIsTheSame) {
  Oven oven;
  const Json json = to_json(settings_of(oven));
  EXPECT_EQ(json, Json::parse(R"({"fan": true, "trays": 2, "number": 7, "rack": {"share": 0.01, "heat": 180.0,
                                  "minutes": null, "mode": "top"}})"));
  Oven other = {false, 1, 1, 1.0F, 60.0, 5.0, "both"};
  assign(settings_of(other), flatten(json));
  EXPECT_EQ(to_json(settings_of(other)), json);
  EXPECT_EQ(other.share, 0.01F) << "to the last bit";
}

TEST(Settings, RangesIncludeTheirEnds) {
  for (const SettingValues& good : {SettingValues{{"trays", 1}},
                                    {{"trays", 3}},
                                    {{"rack.heat", 50}},
                                    {{"rack.minutes", 90}},
                                    {{"number", std::numeric_limits<std::uint64_t>::max()}},
                                    {{"rack.mode", "both"}}}) {
    EXPECT_EQ(refusal(good), "") << good.begin()->first;
  }
}

TEST(Settings, ARefusalNamesKeyValueAndRange) {
  const auto holds = [](const std::string& words, const std::vector<std::string>& parts) {
    return std::all_of(parts.begin(), parts.end(),
                       [&](const std::string& part) { return words.find(part) != std::string::npos; });
  };
  EXPECT_TRUE(holds(refusal({{"trays", 4}}), {"'trays'", "4", "1 to 3"})) << refusal({{"trays", 4}});
  EXPECT_TRUE(holds(refusal({{"rack.heat", 49.5}}), {"'rack.heat'", "49.5", "50 to 250 degrees"}));
  EXPECT_TRUE(holds(refusal({{"rack.mode", "side"}}), {"side", "top, bottom or both"}));
  EXPECT_TRUE(holds(refusal({{"rack.minutes", 0}}), {"1 to 90, or null"}));
  EXPECT_TRUE(holds(refusal({{"number", -1}}), {"at least 0"}));
  EXPECT_TRUE(holds(refusal({{"rack.heat", std::nan("")}}), {"'rack.heat'"}));
  EXPECT_TRUE(holds(refusal({{"trays", 1e12}}), {"'trays'"}));
  EXPECT_TRUE(holds(refusal({{"fan", 1}}), {"true or false"}));
}

TEST(Settings, RulesAreChecked) {
  EXPECT_NE(refusal({{"rack.heat", 245}}).find("the fan needs"), std::string::npos);
  EXPECT_EQ(refusal({{"rack.heat", 245}, {"fan", false}}), "");
}

TEST(Settings, UnknownNamesGetTheNearestOne) {
  EXPECT_NE(refusal({{"tray", 1}}).find("'trays'"), std::string::npos);
  EXPECT_NE(refusal({{"heat", 100}}).find("'rack.heat'"), std::string::npos) << refusal({{"heat", 100}});
  EXPECT_NE(refusal({{"rack", 3}}), "") << "a group is not a setting";
}

TEST(Settings, ExplainSelectsAGroup) {
  Oven oven;
  const std::string rack = explain(settings_of(oven), "rack");
  EXPECT_NE(rack.find("| `rack.heat` | 180.0 | 50 to 250 | degrees | Heat. |\n"), std::string::npos) << rack;
  EXPECT_EQ(rack.find("trays"), std::string::npos);
  EXPECT_NE(explain(settings_of(oven)).find("| `fan` | true | true or false |  | Is the fan on? |"),
            std::string::npos);
  EXPECT_THROW(explain(settings_of(oven), "rac"), Error);
}

}  // namespace
}  // namespace telemime
