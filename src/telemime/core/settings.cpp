// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <type_traits>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

using Json = nlohmann::json;

constexpr const char* kRemedy = "`telemime config --explain` lists all settings with their ranges.";

// The shortest text that is read as the same number: 0.01, not 0.009999999776482582.
template <typename Number>
std::string shortest(Number number) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  return {digits.data(), end};
}

// Number of single-character changes that turn one word into the other (Levenshtein 1966).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j + 1] + 1, row[j] + 1});
    }
  }
  return row.back();
}

// The setting with the most similar name; the last part of the name counts most, since groups change.
std::string most_similar(const SettingTable& table, const std::string& name) {
  const auto last_part = [](std::string_view n) { return n.substr(n.rfind('.') + 1); };
  const auto distance = [&](const Setting& s) {
    return edit_distance(s.name, name) + 3 * edit_distance(last_part(s.name), last_part(name));
  };
  return std::min_element(table.rows.begin(), table.rows.end(),
                          [&](const Setting& a, const Setting& b) { return distance(a) < distance(b); })
      ->name;
}

bool in_group(const std::string& name, const std::string& group) {
  return name.size() > group.size() && name.starts_with(group) && name[group.size()] == '.';
}

Error unknown(const SettingTable& table, const std::string& name, ErrorKind kind) {
  return {kind, "there is no setting '" + name + "'",
          "The most similar one is '" + most_similar(table, name) + "'. " + kRemedy};
}

// Each `read` returns false, and may leave the variable changed, when the value is of a wrong type.
bool read(bool& to, const Json& from) {
  to = from.is_boolean() && from.get<bool>();
  return from.is_boolean();
}
bool read(std::string& to, const Json& from) {
  to = from.is_string() ? from.get<std::string>() : "";
  return from.is_string();
}
template <typename Integer>
requires std::is_integral_v<Integer>
bool read(Integer& to, const Json& from) {
  const bool fits = from.is_number_unsigned()
                        ? std::in_range<Integer>(from.get<std::uint64_t>())
                        : from.is_number_integer() && std::in_range<Integer>(from.get<std::int64_t>());
  to = fits ? from.get<Integer>() : 0;
  return fits;
}
template <typename Real>
requires std::is_floating_point_v<Real>
bool read(Real& to, const Json& from) {
  to = from.is_number() ? static_cast<Real>(from.get<double>()) : 0;
  return from.is_number();
}
bool read(std::optional<double>& to, const Json& from) {
  to.reset();
  return from.is_null() || read(to.emplace(), from);
}

void collect(const Json& object, const std::string& group, SettingValues& values) {
  for (const auto& [key, value] : object.items()) {
    std::string name = group;
    name.append(group.empty() ? "" : ".").append(key);
    if (value.is_object() && !value.empty()) {
      collect(value, name, values);
    } else {
      values[name] = value;
    }
  }
}

bool valid(const Setting& setting) {
  const auto in_range = [&](double x) { return x >= setting.low && x <= setting.high; };
  return std::visit(
      [&](const auto* value) {
        using Value = std::remove_cvref_t<decltype(*value)>;
        if constexpr (std::is_same_v<Value, std::string>) {
          return setting.choices.empty() ||
                 std::count(setting.choices.begin(), setting.choices.end(), *value) > 0;
        } else if constexpr (std::is_same_v<Value, std::optional<double>>) {
          return !*value || in_range(**value);
        } else {
          return std::is_same_v<Value, bool> || in_range(static_cast<double>(*value));
        }
      },
      setting.variable);
}

}  // namespace

void SettingTable::append(SettingTable other) {
  std::move(other.rows.begin(), other.rows.end(), std::back_inserter(rows));
  std::move(other.rules.begin(), other.rules.end(), std::back_inserter(rules));
}

Setting number(std::string name, SettingVariable variable, std::array<double, 2> range, std::string unit,
               std::string meaning) {
  return {.name = std::move(name),
          .variable = variable,
          .low = range[0],
          .high = range[1],
          .unit = std::move(unit),
          .choices = {},
          .meaning = std::move(meaning)};
}

Setting flag(std::string name, bool& variable, std::string meaning) {
  return number(std::move(name), &variable, {0, 1}, "", std::move(meaning));
}

Setting text(std::string name, std::string& variable, std::vector<std::string> choices, std::string meaning) {
  Setting setting = number(std::move(name), &variable, {0, 0}, "", std::move(meaning));
  setting.choices = std::move(choices);
  return setting;
}

void check(const SettingTable& table) {
  for (const Setting& s : table.rows) {
    if (!valid(s)) {
      throw Error(ErrorKind::config, "'" + s.name + "' cannot be " + value_of(s).dump(),
                  "It must be " + range_of(s) + (s.unit.empty() ? "" : " " + s.unit) + ".");
    }
  }
  for (const SettingRule& rule : table.rules) {
    if (!rule.holds) {
      throw Error(ErrorKind::config, rule.sentence, kRemedy);
    }
  }
}

SettingValues flatten(const Json& object) {
  if (!object.is_object()) {
    throw Error(ErrorKind::config, "a configuration must be one JSON object");
  }
  SettingValues values;
  collect(object, "", values);
  return values;
}

Json to_json(const SettingTable& table) {
  Json json = Json::object();
  for (const Setting& s : table.rows) {
    std::string pointer = "/" + s.name;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    json[Json::json_pointer(pointer)] = value_of(s);
  }
  return json;
}

void assign(const SettingTable& table, const SettingValues& values) {
  for (const auto& [name, value] : values) {
    const auto is_empty_group = [&, &group = name, &content = value](const Setting& s) {
      return content.is_object() && content.empty() && in_group(s.name, group);
    };
    if (std::any_of(table.rows.begin(), table.rows.end(), is_empty_group)) {
      continue;
    }
    const auto row = std::find_if(table.rows.begin(), table.rows.end(),
                                  [&wanted = name](const Setting& s) { return s.name == wanted; });
    if (row == table.rows.end()) {
      throw unknown(table, name, ErrorKind::config);
    }
    if (!std::visit([&given = value](auto* to) { return read(*to, given); }, row->variable)) {
      throw Error(ErrorKind::config, "'" + name + "' cannot be " + value.dump(),
                  "It must be " + range_of(*row) + ".");
    }
  }
}

std::string explain(const SettingTable& table, const std::string& name) {
  std::string lines = "| setting | default | range | unit | meaning |\n| --- | --- | --- | --- | --- |\n";
  bool found = false;
  for (const Setting& s : table.rows) {
    if (name.empty() || s.name == name || in_group(s.name, name)) {
      found = true;
      lines += "| `" + s.name + "` | " + value_of(s).dump() + " | " + range_of(s) + " | " + s.unit + " | " +
               s.meaning + " |\n";
    }
  }
  if (!found) {
    throw unknown(table, name, ErrorKind::usage);
  }
  return lines;
}

std::string range_of(const Setting& s) {
  if (std::holds_alternative<bool*>(s.variable)) {
    return "true or false";
  }
  if (std::holds_alternative<std::string*>(s.variable)) {
    std::string words = s.choices.empty() ? "a text" : s.choices.front();
    for (std::size_t i = 1; i < s.choices.size(); ++i) {
      words += (i + 1 < s.choices.size() ? ", " : " or ") + s.choices[i];
    }
    return words;
  }
  const bool integer =
      std::holds_alternative<int*>(s.variable) || std::holds_alternative<std::uint64_t*>(s.variable);
  const auto bound = [&](double x) {
    return integer && std::abs(x) < 1e15 ? std::to_string(static_cast<std::int64_t>(x)) : shortest(x);
  };
  return (std::isinf(s.high) ? "at least " + bound(s.low) : bound(s.low) + " to " + bound(s.high)) +
         (std::holds_alternative<std::optional<double>*>(s.variable) ? ", or null" : "");
}

Json value_of(const Setting& setting) {
  return std::visit(
      [](const auto* value) -> Json {
        using Value = std::remove_cvref_t<decltype(*value)>;
        if constexpr (std::is_same_v<Value, std::optional<double>>) {
          return *value ? Json(**value) : Json(nullptr);
        } else if constexpr (std::is_same_v<Value, float>) {
          return std::isfinite(*value) ? Json(std::stod(shortest(*value))) : Json(*value);
        } else {
          return *value;
        }
      },
      setting.variable);
}

}  // namespace telemime
