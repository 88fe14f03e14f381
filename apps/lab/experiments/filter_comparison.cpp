// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/filter_comparison.h"

#include <algorithm>
#include <cmath>

namespace telemime {
namespace {

std::vector<std::string> value_columns(const std::vector<std::string>& filters) {
  std::vector<std::string> columns;
  for (const std::string& filter : filters) {
    for (const char* what : {"", ", lowest", ", highest"}) {
      columns.push_back(filter_title(filter) + what);
    }
  }
  return columns;
}

// Spread(sweep, count) for each filter, as fields of one row.
template <typename At>
void add_fields(Lab& lab, const std::vector<std::string>& filters, std::size_t count, const At& at,
                std::vector<std::string>& row) {
  for (const std::string& filter : filters) {
    const Spread spread = at(lab.filter(filter), count);
    for (const double value : {spread.mean, spread.low, spread.high}) {
      row.push_back(number(value));
    }
  }
}

Table averages_table(Lab& lab, const std::vector<std::string>& filters, const FilterQuantity& quantity) {
  Table table{std::string(quantity.title) + ", mean over particles and seeds", {"sequence"}, {}};
  for (const PreparedSequence& sequence : lab.gestures()) {
    table.rows.push_back({sequence.name});
  }
  table.rows.push_back({"mean of the four"});
  table.rows.push_back({"spread over the seeds"});
  for (const std::string& filter : filters) {
    table.columns.push_back(filter_title(filter));
    table.columns.emplace_back("+-");
    const FilterAverages averages = averages_of(lab.filter(filter), quantity.measure);
    for (std::size_t s = 0; s < averages.gestures.size(); ++s) {
      table.rows[s].push_back(number(averages.gestures[s]));
      table.rows[s].push_back(number(averages.chance[s]));
    }
    auto& all = table.rows[averages.gestures.size()];
    all.push_back(number(averages.all));
    all.push_back(number(averages.chance_of_all));
    table.rows.back().push_back(number(averages.spread));
    table.rows.back().emplace_back("-");
  }
  return table;
}

// Effort and state of the filters, to explain why they differ.
Table effort_table(Lab& lab, const std::vector<std::string>& filters) {
  Table table{"what the filters spent and kept",
              {"filter", "evaluations / frame", "effective particles", "parts diffused (%)",
               "jitter of the wrists (mm/frame^2)", "mean 2-D error (mm)"},
              {}};
  for (const std::string& filter : filters) {
    const FilterSweep& sweep = lab.filter(filter);
    table.rows.push_back({filter_title(filter), number(sweep.mean_of_all(&FilterRun::evaluations)),
                          number(sweep.mean_of_all(&FilterRun::effective)),
                          number(100.0 * sweep.mean_of_all(&FilterRun::moving)),
                          number(sweep.mean_of_all(&FilterRun::jitter)),
                          number(sweep.mean_of_all(&FilterRun::error_2d))});
  }
  return table;
}

int sign_beyond(double change, double chance) {
  return std::abs(change) <= chance ? 0 : change < 0.0 ? -1 : 1;
}

const char* sign_text(int sign) {
  return sign < 0 ? " (down)" : sign > 0 ? " (up)" : " (may be chance)";
}

}  // namespace

FilterAverages averages_of(const FilterSweep& sweep, FilterMeasure measure) {
  FilterAverages averages;
  std::vector<double> widths;
  for (std::size_t s = 0; s < sweep.sequences; ++s) {
    averages.gestures.push_back(sweep.mean_of_sequence(s, measure));
    averages.chance.push_back(2.0 * sweep.standard_error(s, measure));
    averages.chance_of_all = std::hypot(averages.chance_of_all, averages.chance.back());
    for (std::size_t count = 0; count < sweep.particles.size(); ++count) {
      widths.push_back(sweep.at(s, count, measure).width());
    }
  }
  for (std::size_t count = 1; count < sweep.particles.size(); ++count) {
    averages.rises += std::max(
        0.0, sweep.over_sequences(count, measure).mean - sweep.over_sequences(count - 1, measure).mean);
  }
  averages.all = mean_of(averages.gestures);
  averages.chance_of_all /= static_cast<double>(sweep.sequences);
  averages.spread = mean_of(widths);
  return averages;
}

int change_of(const FilterAverages& a, const FilterAverages& b, std::size_t gesture) {
  return sign_beyond(b.gestures[gesture] - a.gestures[gesture],
                     std::hypot(a.chance[gesture], b.chance[gesture]));
}

int change_of_all(const FilterAverages& a, const FilterAverages& b) {
  return sign_beyond(b.all - a.all, std::hypot(a.chance_of_all, b.chance_of_all));
}

std::string described_change(Lab& lab, const FilterAverages& from, const FilterAverages& to) {
  std::string text;
  for (std::size_t s = 0; s < from.gestures.size(); ++s) {
    text += lab.gestures()[s].name + " " + number(from.gestures[s]) + " -> " + number(to.gestures[s]) +
            sign_text(change_of(from, to, s)) + ", ";
  }
  return text + "mean " + number(from.all) + " -> " + number(to.all) + sign_text(change_of_all(from, to));
}

Finding compare_filters(Lab& lab, const std::vector<std::string>& filters, const FilterQuantity& quantity) {
  Finding finding;
  Table all{std::string(quantity.title) + " by gesture", {"sequence", "particles"}, {}};
  Table mean{std::string(quantity.title) + " over the four", {"particles"}, {}};
  for (const std::string& column : value_columns(filters)) {
    all.columns.push_back(column);
    mean.columns.push_back(column);
  }
  const std::vector<int> particles = lab.filter(filters.front()).particles;
  const auto over_all = [&](const FilterSweep& sweep, std::size_t count) {
    return sweep.over_sequences(count, quantity.measure);
  };
  for (std::size_t count = 0; count < particles.size(); ++count) {
    mean.rows.push_back({std::to_string(particles[count])});
    add_fields(lab, filters, count, over_all, mean.rows.back());
  }
  for (std::size_t s = 0; s < lab.gestures().size(); ++s) {
    const std::string& name = lab.gestures()[s].name;
    const auto of_gesture = [&](const FilterSweep& sweep, std::size_t count) {
      return sweep.at(s, count, quantity.measure);
    };
    for (std::size_t count = 0; count < particles.size(); ++count) {
      all.rows.push_back({name, std::to_string(particles[count])});
      add_fields(lab, filters, count, of_gesture, all.rows.back());
    }
  }
  finding.tables = {averages_table(lab, filters, quantity), mean, all, effort_table(lab, filters)};
  return finding;
}

}  // namespace telemime
