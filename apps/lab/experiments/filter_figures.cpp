// SPDX-License-Identifier: Apache-2.0
// Figures 4-11 to 4-30: each heuristic of the particle filter alone, and all together, beside CONDENSATION.
#include <algorithm>
#include <cmath>

#include "lab/experiments/experiments.h"
#include "lab/experiments/filter_comparison.h"

namespace telemime {
namespace {

// In the order of Lab::gestures.
enum Gesture : std::size_t { kRaisingArms, kJoy, kExclaiming, kAsking };

constexpr double kNoticeable = 0.05;      // share of the error
constexpr double kMostPublished = 120.0;  // mm, all heuristics together
constexpr double kFewParents = 10.0;      // effective particles

struct Comparison {
  Finding finding;
  FilterAverages base;
  FilterAverages with;
  std::string words;

  /// -1 lower with the heuristic, 1 higher, 0 it may be chance.
  int change(std::size_t gesture) const { return change_of(base, with, gesture); }
  int change_of_mean() const { return change_of_all(base, with); }
  /// Gestures with this change.
  int gestures(int which) const {
    int count = 0;
    for (std::size_t s = 0; s < base.gestures.size(); ++s) {
      count += change(s) == which ? 1 : 0;
    }
    return count;
  }
};

Comparison compare(Lab& lab, const std::vector<std::string>& filters, const FilterQuantity& quantity) {
  Comparison c;
  c.finding = compare_filters(lab, filters, quantity);
  c.base = averages_of(lab.filter(filters[0]), quantity.measure);
  c.with = averages_of(lab.filter(filters[1]), quantity.measure);
  c.words = change_in_words(lab, c.base, c.with) + " (CONDENSATION -> " + filter_title(filters[1]) + ").";
  const auto effective = [&](const std::string& filter) {
    return number(lab.filter(filter).mean_of_all(&FilterRun::effective));
  };
  c.finding.notes.push_back(
      "Bands and 'lowest', 'highest' are over " + std::to_string(lab.seeds()) +
      " seeds; '+-' is two standard errors, and a smaller change may be chance. A particle is one evaluation "
      "of F and D_C. In the mean " +
      effective(filters[0]) + " particles carry the weight with CONDENSATION and " + effective(filters[1]) +
      " with " + filter_title(filters[1]) + ".");
  return c;
}

std::string diffused_words(Lab& lab) {
  return "In the mean " + number(100.0 * lab.filter("hpm").mean_of_all(&FilterRun::moving)) +
         " % of the body's parts are diffused: those that uncover enough of their pixels from one frame to "
         "the "
         "next. One that moves slowly, or along the viewing ray, does not.";
}

std::string frames_words(const Lab& lab) {
  return "A frame is mistracked with F above " + number(lab.options().peaks.region) + " or D_C above " +
         number(lab.options().peaks.contour) + " px.";
}

}  // namespace

Finding wd_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "wd"}, kError3d);
  c.finding.notes.push_back("The spread over the seeds is " + number(c.base.spread) +
                            " mm with CONDENSATION and " + number(c.with.spread) +
                            " mm with weight-based resampling.");
  if (lab.filter("wd").mean_of_all(&FilterRun::effective) < kFewParents) {
    c.finding.notes.emplace_back(
        "Where so few particles carry the weight, both ways of resampling draw the children of the same "
        "parents; what is left of the difference is the one child that is not diffused.");
  }
  c.finding.verdict =
      verdict({c.gestures(-1) >= 1 && c.gestures(-1) <= 3, c.with.spread > c.base.spread}, c.words);
  return c.finding;
}

Finding wd_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "wd"}, kMistracked);
  c.finding.notes.push_back(frames_words(lab));
  c.finding.verdict = verdict({c.change_of_mean() < 0, c.change(kAsking) < 0}, c.words);
  return c.finding;
}

Finding hpm_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "hpm"}, kError3d);
  c.finding.notes.push_back(diffused_words(lab));
  c.finding.verdict = verdict(
      {c.change(kRaisingArms) < 0, c.change(kJoy) < 0, c.change(kExclaiming) >= 0, c.change(kAsking) >= 0},
      c.words);
  return c.finding;
}

Finding hpm_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "hpm"}, kMistracked);
  c.finding.notes.push_back(frames_words(lab));
  c.finding.notes.push_back(diffused_words(lab));
  c.finding.verdict =
      verdict({c.gestures(-1) >= 3, c.change(kRaisingArms) < 0, c.change(kAsking) <= 0}, c.words);
  return c.finding;
}

Finding lo_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "lo"}, kError3d);
  c.finding.verdict =
      verdict({c.change(kJoy) > 0, c.change(kExclaiming) > 0, c.change(kAsking) > 0}, c.words);
  return c.finding;
}

Finding lo_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "lo"}, kMistracked);
  c.finding.notes.push_back(frames_words(lab));
  c.finding.verdict = verdict({c.gestures(-1) == 4, c.change_of_mean() < 0}, c.words);
  return c.finding;
}

Finding kf_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "kf"}, kError3d);
  const double flat = lab.filter("kf").mean_of_all(&FilterRun::error_2d);
  c.finding.notes.push_back("The 2-D error is " +
                            number(lab.filter(kCondensation).mean_of_all(&FilterRun::error_2d)) +
                            " mm with CONDENSATION and " + number(flat) +
                            " mm with flipping: what changes in 3-D and not in 2-D is depth. The flips are "
                            "measured besides the particles, and as many of the lightest are dropped.");
  c.finding.verdict =
      verdict({c.change_of_mean() == 0 || std::abs(c.with.all / c.base.all - 1.0) < kNoticeable}, c.words);
  return c.finding;
}

Finding kf_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "kf"}, kMistracked);
  c.finding.notes.push_back(frames_words(lab) +
                            " From one number of particles to the next, the mean rises by " +
                            number(c.base.rises) + " frames in all with CONDENSATION and by " +
                            number(c.with.rises) + " with flipping.");
  c.finding.verdict = verdict({c.change_of_mean() < 0, c.with.rises <= c.base.rises}, c.words);
  return c.finding;
}

Finding ee_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "ee"}, kError3d);
  c.finding.verdict = verdict(
      {c.change(kJoy) < 0, c.change(kExclaiming) < 0, c.change(kAsking) < 0, c.change(kRaisingArms) >= 0},
      c.words);
  return c.finding;
}

Finding ee_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "ee"}, kMistracked);
  c.finding.notes.push_back(frames_words(lab));
  const double asking = c.base.gestures[kAsking] - c.with.gestures[kAsking];
  bool most = true;
  for (std::size_t s = 0; s < c.base.gestures.size(); ++s) {
    most = most && c.base.gestures[s] - c.with.gestures[s] <= asking;
  }
  c.finding.verdict = verdict({c.change_of_mean() < 0, c.change(kAsking) < 0, most}, c.words);
  return c.finding;
}

Finding all_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, kAllTogether, kOurFilter}, kError3d);
  const FilterAverages ours = averages_of(lab.filter(kOurFilter), kError3d.measure);
  const auto [low, high] = std::minmax_element(c.with.gestures.begin(), c.with.gestures.end());
  c.finding.notes.push_back("Our filter: " + change_in_words(lab, c.base, ours) +
                            " (CONDENSATION -> ours). It evaluates more than it has particles where they are "
                            "fewer than its least effort, see the last table.");
  c.finding.verdict = verdict({c.gestures(-1) == 4, *high <= kMostPublished, *high <= 1.5 * *low}, c.words);
  return c.finding;
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
  c.finding.notes.push_back(frames_words(lab) +
                            " With more than 200 particles all heuristics together leave "
                            "at most " +
                            number(worst) + " mistracked frames on a gesture, mean of the seeds.");
  c.finding.notes.push_back("Our filter: " + change_in_words(lab, c.base, ours) + " (CONDENSATION -> ours).");
  c.finding.verdict = verdict({c.change_of_mean() < 0, c.gestures(-1) == 4, worst == 0.0}, c.words);
  return c.finding;
}

}  // namespace telemime
