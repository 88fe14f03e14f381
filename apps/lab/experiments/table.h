// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <type_traits>
#include <vector>

namespace telemime {

/// Rows of text under column names, for CSV files and the terminal.
struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// A column of numbers.
struct Column {
  std::string name;
  std::vector<double> values;
};

/// Four significant digits; "-" for a number that is not finite.
std::string number(double value);

/// Appends fields to a row: text as it is, whole numbers in full, others as number() writes them.
template <typename... Fields>
void add_fields(std::vector<std::string>& row, const Fields&... fields) {
  const auto text = [](const auto& field) {
    using Field = std::decay_t<decltype(field)>;
    if constexpr (std::is_floating_point_v<Field>) {
      return number(field);
    } else if constexpr (std::is_integral_v<Field>) {
      return std::to_string(field);
    } else {
      return std::string(field);
    }
  };
  (row.push_back(text(fields)), ...);
}

/// A row of these fields.
template <typename... Fields>
std::vector<std::string> row_of(const Fields&... fields) {
  std::vector<std::string> row;
  add_fields(row, fields...);
  return row;
}

/// "160x120".
inline std::string size_name(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

/// The columns side by side; all have the length of the first.
Table table_of(const std::string& title, const std::vector<Column>& columns);

/// One line for the columns, one for each row; fields with a comma, quote or line break are quoted.
std::string to_csv(const Table& table);

/// Columns aligned with spaces, for a terminal.
std::string to_text(const Table& table);

/// The columns of `published` appended to the rows of `measured` that have the same first field; "-" in the
/// other rows.
Table beside(const Table& measured, const Table& published);

}  // namespace telemime
