// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lab/experiments/table.h"

namespace telemime {

struct Plot {
  std::string name;  ///< of the file, without its ending
  std::string svg;
};

/// What one experiment found.
struct Finding {
  std::vector<Table> tables;  ///< titles become file names
  std::vector<Plot> plots;
  std::vector<std::string> notes;  ///< what is seen, in plain words
  std::string verdict;             ///< whether it agrees with the thesis, and in what
};

/// A finding with what it answers.
struct Section {
  std::string id;
  std::string title;
  std::string question;
  Table published;
  Finding finding;
};

/// What the thesis reports for an experiment (experiments/<id>/published.csv); no rows for an unknown id.
Table published_values(const std::string& id);

/// Writes the tables (CSV) and plots (SVG) of a section to folder/<id>/. Throws Error(output).
void write_section(const std::filesystem::path& folder, const Section& section);

/// One HTML page that needs no other file. `conditions`: how it was measured, one line each.
std::string report_page(const std::vector<Section>& sections, const std::vector<std::string>& conditions);

/// Writes a text file. Throws Error(output) that names it.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace telemime
