// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

std::string csv_field(const std::string& field) {
  if (field.find_first_of(",\"\n\r") == std::string::npos) {
    return field;
  }
  std::string quoted = "\"";
  for (const char c : field) {
    quoted += c;
    if (c == '"') {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    line += (i > 0 ? "," : "") + csv_field(fields[i]);
  }
  return line + "\n";
}

std::vector<std::vector<std::string>> csv_rows(std::string_view text) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row;
  std::string field;
  bool quoted = false;
  bool open = false;  // a row has begun
  const auto end_row = [&] {
    row.push_back(std::move(field));
    rows.push_back(std::move(row));
    field.clear();
    row.clear();
    open = false;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n' && !quoted) {
      if (open) {
        end_row();
      }
      continue;
    }
    open = true;
    if (c == '"') {
      if (quoted && i + 1 < text.size() && text[i + 1] == '"') {
        field += text[++i];
      } else {
        quoted = !quoted;
      }
    } else if (c == ',' && !quoted) {
      row.push_back(std::move(field));
      field.clear();
    } else if (c != '\r' || quoted) {
      field += c;
    }
  }
  if (open) {
    end_row();
  }
  return rows;
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
      table.rows[i].push_back(number(column.values[i]));
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

Table parse_csv(std::string_view text, const std::string& title) {
  auto rows = csv_rows(text);
  Table table;
  table.title = title;
  if (rows.empty()) {
    return table;
  }
  table.columns = std::move(rows.front());
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].size() != table.columns.size()) {
      throw Error(ErrorKind::input, title + ": row " + std::to_string(i) +
                                        " and the first line differ in their number of fields");
    }
    table.rows.push_back(std::move(rows[i]));
  }
  return table;
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
