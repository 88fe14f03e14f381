// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/filter_sweep.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "lab/experiments/table.h"

namespace telemime {
namespace {

int sign_beyond(double change, double chance) {
  return std::abs(change) <= chance ? 0 : change < 0.0 ? -1 : 1;
}

}  // namespace

FilterRun summary_of(const Trace& trace, const PeakThresholds& peaks) {
  FilterRun run;
  run.error_3d = mean_of(trace.error_3d);
  run.error_2d = mean_of(trace.error_2d);
  run.mistracked = static_cast<double>(count_mistracked(trace, peaks));
  run.jitter = trace.jitter;
  run.evaluations = mean_of(trace.evaluations);
  run.effective = mean_of(trace.effective);
  run.moving = mean_of(trace.moving);
  return run;
}

Spread spread_of(std::span<const double> values) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Spread spread{mean_of({values.begin(), values.end()}), nan, nan};
  for (const double value : values) {
    // fmin and fmax pass over NaN.
    spread.low = std::fmin(spread.low, value);
    spread.high = std::fmax(spread.high, value);
  }
  return spread;
}

std::string mean_and_range(const Spread& spread) {
  return number(spread.mean) + " (" + number(spread.low) + " to " + number(spread.high) + ")";
}

void longest_first(std::span<const double> lengths, const std::function<void(std::size_t)>& work) {
  std::vector<std::size_t> order(lengths.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return lengths[a] > lengths[b]; });
  std::atomic<std::size_t> next{0};
  tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t) { work(order[next++]); });
}

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

}  // namespace telemime
