// SPDX-License-Identifier: Apache-2.0
// Figures 4-11 to 4-30: each heuristic of the particle filter alone, and all together, beside CONDENSATION.
#include <algorithm>

#include "telemime/experiments/experiments.h"
#include "telemime/experiments/filter_comparison.h"

namespace telemime {
namespace {

// In the order of Lab::gestures.
enum Gesture : std::size_t { kRaisingArms, kJoy, kExclaiming, kAsking };

// A change below this share is none: runs with other seeds differ by as much.
constexpr double kNoticeable = 0.05;

struct Comparison {
  Finding finding;
  FilterAverages base;
  FilterAverages with;
  std::string words;

  bool lower(std::size_t gesture) const { return with.gestures[gesture] < base.gestures[gesture]; }
  bool higher(std::size_t gesture) const { return with.gestures[gesture] > base.gestures[gesture]; }
  /// Relative change of one gesture; negative: lower with the heuristic.
  double change(std::size_t gesture) const { return with.gestures[gesture] / base.gestures[gesture] - 1.0; }
  double change_of_all() const { return with.all / base.all - 1.0; }
};

Comparison compare(Lab& lab, const std::vector<std::string>& filters, const FilterQuantity& quantity) {
  Comparison c;
  c.finding = compare_filters(lab, filters, quantity);
  c.base = averages_of(lab.filter(filters[0]), quantity.measure);
  c.with = averages_of(lab.filter(filters[1]), quantity.measure);
  c.words = change_in_words(lab, c.base, c.with) + " (CONDENSATION -> " + filter_title(filters[1]) + ").";
  c.finding.notes.push_back("Bands and columns 'lowest' and 'highest' are over " +
                            std::to_string(lab.seeds()) +
                            " seeds. A particle is one evaluation of F and D_C.");
  return c;
}

std::string frames_words(const Lab& lab) {
  return "A frame is mistracked with F above " + number(lab.options().peaks.region) + " or D_C above " +
         number(lab.options().peaks.contour) + " px.";
}

}  // namespace

Finding wd_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "wd"}, kError3d);
  const int lower = gestures_within(c.with, c.base, 1.0);
  c.finding.notes.push_back("The spread over the seeds is " + number(c.base.spread) +
                            " mm with CONDENSATION and " + number(c.with.spread) +
                            " mm with weight-based resampling.");
  c.finding.verdict = verdict({lower >= 1 && lower <= 3, c.with.spread > c.base.spread}, c.words);
  return c.finding;
}

Finding wd_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "wd"}, kMistracked);
  c.finding.notes.push_back(frames_words(lab));
  c.finding.verdict = verdict({c.with.all < c.base.all, c.lower(kAsking)}, c.words);
  return c.finding;
}

Finding hpm_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "hpm"}, kError3d);
  c.finding.verdict = verdict({c.change(kRaisingArms) < -kNoticeable, c.change(kJoy) < -kNoticeable,
                               c.change(kExclaiming) > -kNoticeable, c.change(kAsking) > -kNoticeable},
                              c.words);
  return c.finding;
}

Finding hpm_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "hpm"}, kMistracked);
  c.finding.notes.push_back(frames_words(lab));
  c.finding.verdict =
      verdict({gestures_within(c.with, c.base, 1.0) >= 3, c.lower(kRaisingArms), c.lower(kAsking)}, c.words);
  return c.finding;
}

Finding lo_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "lo"}, kError3d);
  c.finding.verdict = verdict({c.higher(kJoy), c.higher(kExclaiming), c.higher(kAsking)}, c.words);
  return c.finding;
}

Finding lo_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "lo"}, kMistracked);
  c.finding.notes.push_back(frames_words(lab));
  c.finding.verdict =
      verdict({gestures_within(c.with, c.base, 1.0) == 4, c.change_of_all() < -0.25}, c.words);
  return c.finding;
}

Finding kf_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "kf"}, kError3d);
  c.finding.verdict = verdict({std::abs(c.change_of_all()) < 2.0 * kNoticeable}, c.words);
  return c.finding;
}

Finding kf_robustness(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "kf"}, kMistracked);
  c.finding.notes.push_back(frames_words(lab) +
                            " From one number of particles to the next, the mean rises by " +
                            number(c.base.rises) + " frames in all with CONDENSATION and by " +
                            number(c.with.rises) + " with flipping.");
  c.finding.verdict = verdict({c.with.all < c.base.all, c.with.rises <= c.base.rises}, c.words);
  return c.finding;
}

Finding ee_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, "ee"}, kError3d);
  c.finding.verdict = verdict(
      {c.lower(kJoy), c.lower(kExclaiming), c.lower(kAsking), c.change(kRaisingArms) > -2.0 * kNoticeable},
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
  c.finding.verdict = verdict({c.with.all < c.base.all, c.lower(kAsking), most}, c.words);
  return c.finding;
}

Finding all_accuracy(Lab& lab) {
  Comparison c = compare(lab, {kCondensation, kAllTogether, kOurFilter}, kError3d);
  const FilterAverages ours = averages_of(lab.filter(kOurFilter), kError3d.measure);
  const auto [low, high] = std::minmax_element(c.with.gestures.begin(), c.with.gestures.end());
  c.finding.notes.push_back("Our filter: " + change_in_words(lab, c.base, ours) +
                            " (CONDENSATION -> ours). It evaluates more than it has particles where they are "
                            "fewer than its least effort, see the last table.");
  c.finding.verdict = verdict(
      {gestures_within(c.with, c.base, 1.0) == 4, *low >= 70.0 && *high <= 130.0, *high <= 1.5 * *low},
      c.words);
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
  c.finding.verdict = verdict({gestures_within(c.with, c.base, 1.0) == 4, worst == 0.0}, c.words);
  return c.finding;
}

}  // namespace telemime
