// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace telemime {

/// Rows of text under column names, for CSV files and the report.
struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// Four significant digits; "-" for a number that is not finite.
std::string number(double value);

/// One line for the columns, one for each row; fields with a comma, quote or line break are quoted.
std::string to_csv(const Table& table);

/// Reads what to_csv() writes. Throws Error(input) for a row of another length than the first.
Table parse_csv(std::string_view text, const std::string& title);

/// Columns lined up with spaces, for a terminal.
std::string to_text(const Table& table);

/// An HTML <table>; all text is escaped.
std::string to_html(const Table& table);

/// &, <, > and " replaced, for HTML and SVG.
std::string escaped(std::string_view text);

}  // namespace telemime
