// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
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

/// The columns side by side; all have the length of the first.
Table table_of(const std::string& title, const std::vector<Column>& columns);

/// One line for the columns, one for each row; fields with a comma, quote or line break are quoted.
std::string to_csv(const Table& table);

/// Reads what to_csv() writes. Throws Error(input) for a row whose length differs from the first line's.
Table parse_csv(std::string_view text, const std::string& title);

/// Columns aligned with spaces, for a terminal.
std::string to_text(const Table& table);

/// The columns of `published` appended to the rows of `measured` that have the same first field; "-" in the
/// other rows.
Table beside(const Table& measured, const Table& published);

}  // namespace telemime
