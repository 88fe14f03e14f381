// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lab/experiments/sequence.h"

namespace telemime {

/// One quantity over the seeds.
struct Spread {
  double mean = 0.0;
  double low = 0.0;
  double high = 0.0;
  double width() const { return high - low; }
};

/// Of the finite values; all NaN of none.
Spread spread_of(std::span<const double> values);

/// "mean (low to high)".
std::string mean_and_range(const Spread& spread);

/// Calls work(i) for all i below lengths.size() in parallel, the longest first, so that no core waits long
/// for the last one.
void longest_first(std::span<const double> lengths, const std::function<void(std::size_t)>& work);

/// Every sequence tracked with several numbers of particles, each with several seeds. `Run` summarises one
/// run over one sequence in numbers.
template <typename Run>
struct Sweep {
  using Measure = double Run::*;

  std::vector<int> particles;
  std::size_t sequences = 0;
  std::size_t seeds = 0;
  std::vector<Run> runs;  ///< by sequence, then particles, then seed

  const Run& run(std::size_t sequence, std::size_t count, std::size_t seed) const {
    return runs[(sequence * particles.size() + count) * seeds + seed];
  }
  /// Of one sequence, over the seeds.
  Spread at(std::size_t sequence, std::size_t count, Measure measure) const {
    return spread_of(each(seeds, [&](std::size_t i) { return run(sequence, count, i).*measure; }));
  }
  /// The same of the mean over the sequences.
  Spread over_sequences(std::size_t count, Measure measure) const {
    return spread_of(each(seeds, [&](std::size_t i) {
      return mean_of(each(sequences, [&](std::size_t s) { return run(s, count, i).*measure; }));
    }));
  }
  /// Of one sequence, mean over all numbers of particles and seeds.
  double mean_of_sequence(std::size_t sequence, Measure measure) const {
    return mean_of(
        each(particles.size(), [&](std::size_t count) { return at(sequence, count, measure).mean; }));
  }
  double mean_of_all(Measure measure) const {
    return mean_of(each(sequences, [&](std::size_t s) { return mean_of_sequence(s, measure); }));
  }
  /// Standard error of mean_of_sequence: what the choice of seeds does to it. 0 for a single seed.
  double standard_error(std::size_t sequence, Measure measure) const {
    double sum = 0.0;  // of the variances of the means over the seeds
    for (std::size_t count = 0; count < particles.size() && seeds > 1; ++count) {
      const double mean = at(sequence, count, measure).mean;
      for (std::size_t i = 0; i < seeds; ++i) {
        const double away = run(sequence, count, i).*measure - mean;
        sum += away * away / static_cast<double>((seeds - 1) * seeds);
      }
    }
    return std::sqrt(sum) / static_cast<double>(particles.size());
  }

 private:
  template <typename Value>
  static std::vector<double> each(std::size_t count, const Value& value) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = value(i);
    }
    return values;
  }
};

/// Makes the runs in parallel by run(sequence, particles, seed), with the seeds first_seed, first_seed + 1,
/// ... `lengths` are those of the sequences, in frames. Results do not depend on the number of cores.
template <typename Run, typename Track>
Sweep<Run> sweep(std::span<const double> lengths, std::vector<int> particles, std::uint64_t first_seed,
                 std::size_t seeds, const Track& run) {
  Sweep<Run> result{std::move(particles), lengths.size(), seeds, {}};
  std::vector<double> efforts;
  for (const double length : lengths) {
    for (const int count : result.particles) {
      efforts.insert(efforts.end(), seeds, count * length);
    }
  }
  result.runs.resize(efforts.size());
  longest_first(efforts, [&](std::size_t i) {
    const std::size_t cell = i / seeds;
    result.runs[i] = run(cell / result.particles.size(), result.particles[cell % result.particles.size()],
                         first_seed + i % seeds);
  });
  return result;
}

/// Summary of one run of a filter over one sequence.
struct FilterRun {
  double error_3d = 0.0;     ///< mm
  double error_2d = 0.0;     ///< mm
  double mistracked = 0.0;   ///< frames
  double jitter = 0.0;       ///< mm/frame^2
  double evaluations = 0.0;  ///< a frame
  double effective = 0.0;    ///< particles that carry the weight; NaN without particles
  double moving = 0.0;       ///< share of the body's parts that were diffused; NaN without particles
};
using FilterMeasure = double FilterRun::*;
using FilterSweep = Sweep<FilterRun>;

FilterRun summary_of(const Trace& trace, const PeakThresholds& peaks);

/// One filter, by gesture in the order of the thesis (raising arms, joy, exclaiming, asking) and in the mean;
/// each the mean over all numbers of particles and seeds.
struct FilterAverages {
  std::vector<double> gestures;
  double all = 0.0;
  std::vector<double> chance;  ///< by gesture: two standard errors, what other seeds may change
  double chance_of_all = 0.0;
  double spread = 0.0;  ///< from the lowest to the highest seed, mean over gestures and numbers of particles
  double rises = 0.0;   ///< summed steps up from one number of particles to the next, of the gestures' mean
};
FilterAverages averages_of(const FilterSweep& sweep, FilterMeasure measure);

/// The change from a to b: -1 a fall, 1 a rise, 0 within chance.
int change_of(const FilterAverages& a, const FilterAverages& b, std::size_t gesture);
int change_of_all(const FilterAverages& a, const FilterAverages& b);

}  // namespace telemime
