// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace telemime {

/// The variable that holds a setting's value.
using SettingVariable =
    std::variant<bool*, int*, std::uint64_t*, float*, double*, std::optional<double>*, std::string*>;

/// One row of the table of settings. The default is the variable's value in a default-constructed structure.
struct Setting {
  std::string name;  ///< as in a configuration file, groups separated by dots: "filter.trust"
  SettingVariable variable;
  double low = 0.0;                  ///< smallest valid number
  double high = 0.0;                 ///< largest valid number
  std::string unit;                  ///< of a number; empty: none
  std::vector<std::string> choices;  ///< valid texts; empty: any text
  std::string meaning;               ///< one sentence
};

/// A condition on several settings at once, or on the content of a text.
struct SettingRule {
  bool holds = true;
  std::string sentence;  ///< "filter.mode_least must not be above filter.mode_most"
};

/// The settings of one structure. Every module that has settings defines `SettingTable settings_of(Config&)`
/// beside its structure; the whole table is the concatenation of these.
struct SettingTable {
  std::vector<Setting> rows;
  std::vector<SettingRule> rules;  ///< evaluated when the table is made

  void append(SettingTable other);
};

Setting number(std::string name, SettingVariable variable, std::array<double, 2> range, std::string unit,
               std::string meaning);
Setting flag(std::string name, bool& variable, std::string meaning);
Setting text(std::string name, std::string& variable, std::vector<std::string> choices, std::string meaning);

/// Throws Error(config) that names the first setting outside its range, or the first rule that does not hold.
void check(const SettingTable& table);

/// The same for a structure for which `settings_of` is defined.
template <typename Structure>
void check_settings(Structure structure) {
  check(settings_of(structure));
}

/// Values by the names of their settings.
using SettingValues = std::map<std::string, nlohmann::json>;

/// The values of a JSON object whose groups are nested objects. Throws Error(config) when it is not an
/// object.
SettingValues flatten(const nlohmann::json& object);

/// The inverse of flatten, for all settings of the table.
nlohmann::json to_json(const SettingTable& table);

/// Writes the values to the variables of the table. Throws Error(config) that names an unknown setting (and
/// the most similar one) or a value of a wrong type; ranges are left to check().
void assign(const SettingTable& table, const SettingValues& values);

/// The table as Markdown: name, default (the present value), range, unit and meaning. `name` selects a
/// setting or a group; empty: all. Throws Error(usage) when there is none of that name.
std::string explain(const SettingTable& table, const std::string& name = {});

/// The valid values of a setting in words: "0 to 1", "none, recursive or one-euro".
std::string range_of(const Setting& setting);

/// The value of a setting.
nlohmann::json value_of(const Setting& setting);

}  // namespace telemime
