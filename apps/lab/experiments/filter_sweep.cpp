// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/filter_sweep.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "lab/experiments/table.h"

namespace telemime {

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

Spread FilterSweep::at(std::size_t sequence, std::size_t count, FilterMeasure measure) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < seeds; ++i) {
    values.push_back(run(sequence, count, i).*measure);
  }
  return spread_of(values);
}

Spread FilterSweep::over_sequences(std::size_t count, FilterMeasure measure) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < seeds; ++i) {
    std::vector<double> each;
    for (std::size_t s = 0; s < sequences; ++s) {
      each.push_back(run(s, count, i).*measure);
    }
    values.push_back(mean_of(each));
  }
  return spread_of(values);
}

double FilterSweep::mean_of_sequence(std::size_t sequence, FilterMeasure measure) const {
  std::vector<double> values;
  for (std::size_t count = 0; count < particles.size(); ++count) {
    values.push_back(at(sequence, count, measure).mean);
  }
  return mean_of(values);
}

double FilterSweep::mean_of_all(FilterMeasure measure) const {
  std::vector<double> values;
  for (std::size_t s = 0; s < sequences; ++s) {
    values.push_back(mean_of_sequence(s, measure));
  }
  return mean_of(values);
}

double FilterSweep::standard_error(std::size_t sequence, FilterMeasure measure) const {
  if (seeds < 2) {
    return 0.0;
  }
  double sum = 0.0;  // of the variances of the means over the seeds
  for (std::size_t count = 0; count < particles.size(); ++count) {
    const double mean = at(sequence, count, measure).mean;
    for (std::size_t i = 0; i < seeds; ++i) {
      const double away = run(sequence, count, i).*measure - mean;
      sum += away * away / static_cast<double>((seeds - 1) * seeds);
    }
  }
  return std::sqrt(sum) / static_cast<double>(particles.size());
}

FilterSweep sweep(std::span<const PreparedSequence> sequences, std::vector<int> particles,
                  std::uint64_t first_seed, std::size_t seeds, const PeakThresholds& peaks,
                  const FilterSearch& search) {
  FilterSweep result;
  result.particles = std::move(particles);
  result.sequences = sequences.size();
  result.seeds = seeds;
  std::vector<double> lengths;
  for (const PreparedSequence& sequence : sequences) {
    for (const int count : result.particles) {
      lengths.insert(lengths.end(), seeds, count * static_cast<double>(sequence.frames.size()));
    }
  }
  result.runs.resize(lengths.size());
  longest_first(lengths, [&](std::size_t i) {
    const std::size_t cell = i / seeds;
    const Trace trace = search(sequences[cell / result.particles.size()],
                               result.particles[cell % result.particles.size()], first_seed + i % seeds);
    result.runs[i] = summary_of(trace, peaks);
  });
  return result;
}

void longest_first(std::span<const double> lengths, const std::function<void(std::size_t)>& work) {
  std::vector<std::size_t> order(lengths.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return lengths[a] > lengths[b]; });
  std::atomic<std::size_t> next{0};
  tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t) { work(order[next++]); });
}

}  // namespace telemime
