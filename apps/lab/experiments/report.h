// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "lab/experiments/table.h"

namespace telemime {

/// The result of one experiment. plots.py draws its figures from the tables.
struct Finding {
  std::vector<Table> tables;       ///< titles become file names
  cv::Mat picture = {};            ///< written as picture.png; empty: none
  std::vector<std::string> notes;  ///< observations, one paragraph each
  std::string verdict;             ///< whether it agrees with the thesis, and on what
};

/// A finding with the question that it answers.
struct Section {
  std::string id;
  std::string title;
  std::string question;
  Table published;
  Finding finding;
};

/// What the thesis reports for an experiment (the rows of apps/lab/published.csv with this id); no rows for
/// an unknown id.
Table published_values(const std::string& id);

/// Writes the tables (CSV), the picture and section.json, which names them, to folder/<id>/. Throws
/// Error(output).
void write_section(const std::filesystem::path& folder, const Section& section);

/// Writes a text file. Throws Error(output) that names it.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace telemime
