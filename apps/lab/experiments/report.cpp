// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/report.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <string_view>
#include <system_error>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

struct Published {
  std::string_view id;
  std::string_view csv;
};

constexpr Published kPublished[] = {
#include "published.inc"
};

constexpr std::string_view kStyle = R"(
body { font: 16px/1.5 sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
h2 { border-top: 1px solid #bbb; padding-top: 1.2rem; }
table { display: block; max-width: 100%; overflow-x: auto; border-collapse: collapse; margin: .6rem 0 1rem; font-size: .86rem; }
caption { text-align: left; color: #555; }
td, th { border: 1px solid #ccc; padding: .15rem .5rem; text-align: left; }
th { background: #f2f2f2; }
.verdict { background: #eef4ee; border-left: 4px solid #2a8a4a; padding: .4rem .8rem; }
svg { max-width: 100%; height: auto; border: 1px solid #ddd; margin: .3rem .3rem .3rem 0; }
)";

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
  while (!name.empty() && name.back() == '_') {
    name.pop_back();
  }
  return name.empty() ? "data" : name;
}

// Long tables (one row a frame) are in the CSV; the page shows plots of them.
constexpr std::size_t kMostRows = 45;

std::string section_html(const Section& section) {
  std::string html = "<h2 id=\"" + escaped(section.id) + "\">" + escaped(section.id) + " " +
                     escaped(section.title) + "</h2>\n<p>" + escaped(section.question) + "</p>\n";
  if (!section.published.rows.empty()) {
    html += to_html(section.published);
  }
  for (const Table& table : section.finding.tables) {
    html += table.rows.size() <= kMostRows ? to_html(table) : "";
  }
  for (const Plot& plot : section.finding.plots) {
    html += plot.svg;
  }
  for (const std::string& note : section.finding.notes) {
    html += "<p>" + escaped(note) + "</p>\n";
  }
  return html + "<p class=\"verdict\">" + escaped(section.finding.verdict) + "</p>\n";
}

}  // namespace

Table published_values(const std::string& id) {
  for (const Published& entry : kPublished) {
    if (entry.id == id) {
      return parse_csv(entry.csv, "published");
    }
  }
  return {};
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
                "Give --out a folder that you may write, on a disk with room.");
  }
}

void write_section(const std::filesystem::path& folder, const Section& section) {
  for (const Table& table : section.finding.tables) {
    write_text(folder / section.id / (file_name(table.title) + ".csv"), to_csv(table));
  }
  for (const Plot& plot : section.finding.plots) {
    write_text(folder / section.id / (plot.name + ".svg"), plot.svg);
  }
}

std::string report_page(const std::vector<Section>& sections, const std::vector<std::string>& conditions) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Telemime: the thesis's "
      "experiments, measured again</title><style>" +
      std::string(kStyle) +
      "</style></head><body>\n<h1>The thesis's experiments, measured again</h1>\n<p>Published values are "
      "those of D. A. Gomez Jauregui, Telecom SudParis, 2011. In every figure an iteration is one "
      "evaluation of a cost (F or D_C), because that is what time is spent on.</p>\n<ul>\n";
  for (const std::string& condition : conditions) {
    html += "<li>" + escaped(condition) + "</li>\n";
  }
  html += "</ul>\n<ul>\n";
  for (const Section& section : sections) {
    html += "<li><a href=\"#" + escaped(section.id) + "\">" + escaped(section.id) + "</a> " +
            escaped(section.title) + ". " + escaped(section.finding.verdict) + "</li>\n";
  }
  html += "</ul>\n";
  for (const Section& section : sections) {
    html += section_html(section);
  }
  return html + "</body></html>\n";
}

}  // namespace telemime
