// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/report.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <system_error>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr std::string_view kPublished =
#include "published.inc"
    ;

std::string file_name(const std::string& title) {
  std::string name;
  for (const char c : title) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) != 0) {
      name += static_cast<char>(std::tolower(u));
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  return name.substr(0, name.find_last_not_of('_') + 1) + ".csv";
}

// The entry with this name, appended when there is none yet.
template <typename T, typename Name>
T& entry_of(std::vector<T>& entries, const std::string& name, const Name& name_of, const T& fresh) {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const T& entry) { return name_of(entry) == name; });
  return found != entries.end() ? *found : entries.emplace_back(fresh);
}

}  // namespace

Table published_values(const std::string& id) {
  // One line of the file is one cell: id, row, column, value.
  static const Table kCells = parse_csv(kPublished, "published.csv");
  Table table{"published", {"quantity"}, {}};
  for (const auto& cell : kCells.rows) {
    if (cell[0] != id) {
      continue;
    }
    entry_of(
        table.columns, cell[2], [](const auto& column) { return column; }, cell[2]);
    entry_of(table.rows, cell[1], [](const auto& row) { return row.front(); }, {cell[1]}).push_back(cell[3]);
  }
  return table;
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::error_code failure;
  std::filesystem::create_directories(file.parent_path(), failure);
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) {
    throw Error(ErrorKind::output,
                "cannot write " + file.string() + ": " + std::generic_category().message(errno),
                "Give --out a writable folder on a disk with free space.");
  }
}

void write_section(const std::filesystem::path& folder, const Section& section) {
  const std::filesystem::path own = folder / section.id;
  nlohmann::ordered_json json = {{"id", section.id},
                                 {"title", section.title},
                                 {"question", section.question},
                                 {"published", to_csv(section.published)},
                                 {"notes", section.finding.notes},
                                 {"verdict", section.finding.verdict},
                                 {"tables", nlohmann::ordered_json::array()}};
  for (const Table& table : section.finding.tables) {
    write_text(own / file_name(table.title), to_csv(table));
    json["tables"].push_back({{"title", table.title}, {"file", file_name(table.title)}});
  }
  if (!section.finding.picture.empty()) {
    std::vector<unsigned char> png;
    cv::imencode(".png", section.finding.picture, png);
    write_text(own / "picture.png", {png.begin(), png.end()});
  }
  write_text(own / "section.json", json.dump(2) + "\n");
}

}  // namespace telemime
