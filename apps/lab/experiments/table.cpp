// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <sstream>

namespace telemime {
namespace {

std::string csv_field(const std::string& field) {
  if (field.find_first_of(",\"\n\r") == std::string::npos) {
    return field;
  }
  std::ostringstream quoted;
  quoted << std::quoted(field, '"', '"');
  return quoted.str();
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    line += (i > 0 ? "," : "") + csv_field(fields[i]);
  }
  return line + "\n";
}

}  // namespace

std::string number(double value) {
  if (!std::isfinite(value)) {
    return "-";
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

Table table_of(const std::string& title, const std::vector<Column>& columns) {
  Table table{title, {}, std::vector<std::vector<std::string>>(columns.front().values.size())};
  for (const Column& column : columns) {
    table.columns.push_back(column.name);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      add_fields(table.rows[i], column.values[i]);
    }
  }
  return table;
}

std::string to_csv(const Table& table) {
  std::string text = csv_line(table.columns);
  for (const auto& row : table.rows) {
    text += csv_line(row);
  }
  return text;
}

std::string to_text(const Table& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    std::size_t width = table.columns[c].size();
    for (const auto& row : table.rows) {
      width = std::max(width, row[c].size());
    }
    widths.push_back(width);
  }
  std::string text = table.title.empty() ? "" : table.title + "\n";
  const auto line = [&](const std::vector<std::string>& fields) {
    std::string joined;
    for (std::size_t c = 0; c < fields.size(); ++c) {
      joined += fields[c];
      joined += c + 1 < fields.size() ? std::string(widths[c] - fields[c].size() + 2, ' ') : "";
    }
    text += "  " + joined + "\n";
  };
  line(table.columns);
  for (const auto& row : table.rows) {
    line(row);
  }
  return text;
}

Table beside(const Table& measured, const Table& published) {
  Table joined = measured;
  joined.columns.insert(joined.columns.end(), published.columns.begin() + 1, published.columns.end());
  for (auto& row : joined.rows) {
    const auto match = std::find_if(published.rows.begin(), published.rows.end(),
                                    [&](const auto& other) { return other.front() == row.front(); });
    for (std::size_t c = 1; c < published.columns.size(); ++c) {
      row.push_back(match == published.rows.end() ? "-" : (*match)[c]);
    }
  }
  return joined;
}

}  // namespace telemime
