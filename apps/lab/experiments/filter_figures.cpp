// SPDX-License-Identifier: Apache-2.0
// Figures 4-11 to 4-30: each heuristic of the particle filter alone, and all together, beside CONDENSATION.
#include <algorithm>
#include <cmath>

#include "lab/experiments/experiments.h"

namespace telemime {
namespace {

// A quantity of the figures.
struct FilterQuantity {
  FilterMeasure measure;
  const char* title;  // with its unit
};
constexpr FilterQuantity kError3d = {&FilterRun::error_3d, "mean 3-D error (mm)"};
constexpr FilterQuantity kMistracked = {&FilterRun::mistracked, "mistracked frames"};

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
      add_fields(table.rows[s], averages.gestures[s], averages.chance[s]);
    }
    add_fields(table.rows[averages.gestures.size()], averages.all, averages.chance_of_all);
    add_fields(table.rows.back(), averages.spread, "-");
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
    table.rows.push_back(
        row_of(filter_title(filter), sweep.mean_of_all(&FilterRun::evaluations),
               sweep.mean_of_all(&FilterRun::effective), 100.0 * sweep.mean_of_all(&FilterRun::moving),
               sweep.mean_of_all(&FilterRun::jitter), sweep.mean_of_all(&FilterRun::error_2d)));
  }
  return table;
}

const char* sign_text(int sign) {
  return sign < 0 ? " (down)" : sign > 0 ? " (up)" : " (may be chance)";
}

// "raising_arms 120 -> 100 (down), ...; mean ...".
std::string described_change(Lab& lab, const FilterAverages& from, const FilterAverages& to) {
  std::string text;
  for (std::size_t s = 0; s < from.gestures.size(); ++s) {
    text += lab.gestures()[s].name + " " + number(from.gestures[s]) + " -> " + number(to.gestures[s]) +
            sign_text(change_of(from, to, s)) + ", ";
  }
  return text + "mean " + number(from.all) + " -> " + number(to.all) + sign_text(change_of_all(from, to));
}

// Tables of several filters (Lab::filter) beside each other: averages, by number of particles (mean and each
// gesture, with the spread over the seeds), and effort.
Finding compare_filters(Lab& lab, const std::vector<std::string>& filters, const FilterQuantity& quantity) {
  Table all{std::string(quantity.title) + " by gesture", {"sequence", "particles"}, {}};
  Table mean{std::string(quantity.title) + " over the four", {"particles"}, {}};
  for (const std::string& filter : filters) {
    for (const char* what : {"", ", lowest", ", highest"}) {
      all.columns.push_back(filter_title(filter) + what);
      mean.columns.push_back(all.columns.back());
    }
  }
  const std::vector<int> particles = lab.filter(filters.front()).particles;
  // The spread of each filter at one number of particles.
  const auto add_row = [&](Table& table, std::vector<std::string> row, const auto& spread_of_filter) {
    for (const std::string& filter : filters) {
      const Spread spread = spread_of_filter(lab.filter(filter));
      add_fields(row, spread.mean, spread.low, spread.high);
    }
    table.rows.push_back(std::move(row));
  };
  for (std::size_t count = 0; count < particles.size(); ++count) {
    add_row(mean, row_of(particles[count]),
            [&](const FilterSweep& sweep) { return sweep.over_sequences(count, quantity.measure); });
  }
  for (std::size_t s = 0; s < lab.gestures().size(); ++s) {
    for (std::size_t count = 0; count < particles.size(); ++count) {
      add_row(all, row_of(lab.gestures()[s].name, particles[count]),
              [&](const FilterSweep& sweep) { return sweep.at(s, count, quantity.measure); });
    }
  }
  return {.tables = {averages_table(lab, filters, quantity), mean, all, effort_table(lab, filters)}};
}

// In the order of Lab::gestures.
enum : std::size_t { kRaisingArms, kJoy, kExclaiming, kAsking };

constexpr double kNoticeable = 0.05;      // of the error
constexpr double kMostPublished = 120.0;  // mm, all heuristics together
constexpr double kFewParents = 10.0;      // effective particles

// The first filter of the list (CONDENSATION) and the second one compared.
struct Comparison {
  Finding finding;
  FilterAverages base;
  FilterAverages with;
  std::string text;

  /// -1 lower with the heuristic, 1 higher, 0 within chance.
  int change(std::size_t gesture) const { return change_of(base, with, gesture); }
  int change_of_mean() const { return change_of_all(base, with); }
  /// The number of gestures with this change.
  int gestures(int which) const {
    int count = 0;
    for (std::size_t s = 0; s < base.gestures.size(); ++s) {
      count += change(s) == which ? 1 : 0;
    }
    return count;
  }
  void note(const std::string& line) { finding.notes.push_back(line); }
  Finding decided(std::initializer_list<bool> statements) {
    finding.verdict = verdict(statements, text);
    return finding;
  }
};

Comparison compare(Lab& lab, const std::vector<std::string>& filters, const FilterQuantity& quantity) {
  Comparison c;
  c.finding = compare_filters(lab, filters, quantity);
  c.base = averages_of(lab.filter(filters[0]), quantity.measure);
  c.with = averages_of(lab.filter(filters[1]), quantity.measure);
  c.text = described_change(lab, c.base, c.with) + " (CONDENSATION -> " + filter_title(filters[1]) + ").";
  const auto effective = [&](const std::string& filter) {
    return number(lab.filter(filter).mean_of_all(&FilterRun::effective));
  };
  c.note("Bands and the columns 'lowest' and 'highest' are over " + std::to_string(lab.seeds()) +
         " seeds; '+-' is two standard errors, and a smaller change may be chance. A particle is one "
         "evaluation of F and D_C. On average " +
         effective(filters[0]) + " particles carry the weight with CONDENSATION and " +
         effective(filters[1]) + " with " + filter_title(filters[1]) + ".");
  if (quantity.measure == kMistracked.measure) {
    c.note("A frame is mistracked with F above " + number(lab.options().peaks.region) + " or D_C above " +
           number(lab.options().peaks.contour) + " px.");
  }
  if (filters[1] == "hpm") {
    c.note("On average " + number(100.0 * lab.filter("hpm").mean_of_all(&FilterRun::moving)) +
           " % of the body's parts are diffused: those that uncover enough of their pixels from one frame to "
           "the next. A part that moves slowly or along the viewing ray does not.");
  }
  return c;
}

}  // namespace

Finding wd_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "wd"}, kError3d);
  c.note("The spread over the seeds is " + number(c.base.spread) + " mm with CONDENSATION and " +
         number(c.with.spread) + " mm with weight-based resampling.");
  if (lab.filter("wd").mean_of_all(&FilterRun::effective) < kFewParents) {
    c.note(
        "With so few particles carrying the weight, both ways of resampling draw the children of the same "
        "parents; the remaining difference is the one child that is not diffused.");
  }
  return c.decided({c.gestures(-1) >= 1 && c.gestures(-1) <= 3, c.with.spread > c.base.spread});
}

Finding wd_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "wd"}, kMistracked);
  return c.decided({c.change_of_mean() < 0, c.change(kAsking) < 0});
}

Finding hpm_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "hpm"}, kError3d);
  return c.decided(
      {c.change(kRaisingArms) < 0, c.change(kJoy) < 0, c.change(kExclaiming) >= 0, c.change(kAsking) >= 0});
}

Finding hpm_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "hpm"}, kMistracked);
  return c.decided({c.gestures(-1) >= 3, c.change(kRaisingArms) < 0, c.change(kAsking) <= 0});
}

Finding lo_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "lo"}, kError3d);
  return c.decided({c.change(kJoy) > 0, c.change(kExclaiming) > 0, c.change(kAsking) > 0});
}

Finding lo_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "lo"}, kMistracked);
  return c.decided({c.gestures(-1) == 4, c.change_of_mean() < 0});
}

Finding kf_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "kf"}, kError3d);
  c.note(
      "The 2-D error is " + number(lab.filter(kCondensation).mean_of_all(&FilterRun::error_2d)) +
      " mm with CONDENSATION and " + number(lab.filter("kf").mean_of_all(&FilterRun::error_2d)) +
      " mm with flipping: what changes in 3-D and not in 2-D is depth. The flips are evaluated in addition "
      "to the particles, and as many of the lightest are dropped.");
  return c.decided({c.change_of_mean() == 0 || std::abs(c.with.all / c.base.all - 1.0) < kNoticeable});
}

Finding kf_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "kf"}, kMistracked);
  c.note("From one number of particles to the next, the mean rises by " + number(c.base.rises) +
         " frames in total with CONDENSATION and by " + number(c.with.rises) + " with flipping.");
  return c.decided({c.change_of_mean() < 0, c.with.rises <= c.base.rises});
}

Finding ee_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "ee"}, kError3d);
  return c.decided(
      {c.change(kJoy) < 0, c.change(kExclaiming) < 0, c.change(kAsking) < 0, c.change(kRaisingArms) >= 0});
}

Finding ee_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "ee"}, kMistracked);
  const double asking = c.base.gestures[kAsking] - c.with.gestures[kAsking];
  bool most = true;
  for (std::size_t s = 0; s < c.base.gestures.size(); ++s) {
    most = most && c.base.gestures[s] - c.with.gestures[s] <= asking;
  }
  return c.decided({c.change_of_mean() < 0, c.change(kAsking) < 0, most});
}

Finding all_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, kAllTogether, kOurFilter}, kError3d);
  const FilterAverages ours = averages_of(lab.filter(kOurFilter), kError3d.measure);
  const auto [low, high] = std::minmax_element(c.with.gestures.begin(), c.with.gestures.end());
  c.note("Our filter: " + described_change(lab, c.base, ours) +
         " (CONDENSATION -> ours). With few particles it evaluates more often than it has particles, see the "
         "last table.");
  return c.decided({c.gestures(-1) == 4, *high <= kMostPublished, *high <= 1.5 * *low});
}

Finding all_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, kAllTogether, kOurFilter}, kMistracked);
  const FilterSweep& with = lab.filter(kAllTogether);
  double worst = 0.0;
  for (std::size_t s = 0; s < with.sequences; ++s) {
    for (std::size_t count = 0; count < with.particles.size(); ++count) {
      worst = with.particles[count] > 200 ? std::max(worst, with.at(s, count, &FilterRun::mistracked).mean)
                                          : worst;
    }
  }
  const FilterAverages ours = averages_of(lab.filter(kOurFilter), kMistracked.measure);
  c.note("With more than 200 particles all heuristics together leave at most " + number(worst) +
         " mistracked frames on a gesture, mean of the seeds.");
  c.note("Our filter: " + described_change(lab, c.base, ours) + " (CONDENSATION -> ours).");
  return c.decided({c.change_of_mean() < 0, c.gestures(-1) == 4, worst == 0.0});
}

}  // namespace telemime
