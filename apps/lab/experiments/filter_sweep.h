// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "lab/experiments/sequence.h"

namespace telemime {

/// Summary of one run over one sequence.
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

FilterRun summary_of(const Trace& trace, const PeakThresholds& peaks);

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

/// Every sequence tracked with several numbers of particles (or other settings), each with several seeds.
struct FilterSweep {
  std::vector<int> particles;
  std::size_t sequences = 0;
  std::size_t seeds = 0;
  std::vector<FilterRun> runs;  ///< by sequence, then particles, then seed

  const FilterRun& run(std::size_t sequence, std::size_t count, std::size_t seed) const {
    return runs[(sequence * particles.size() + count) * seeds + seed];
  }
  /// Of one sequence, over the seeds.
  Spread at(std::size_t sequence, std::size_t count, FilterMeasure measure) const;
  /// The same of the mean over the sequences.
  Spread over_sequences(std::size_t count, FilterMeasure measure) const;
  /// Of one sequence, mean over all numbers of particles and seeds.
  double mean_of_sequence(std::size_t sequence, FilterMeasure measure) const;
  double mean_of_all(FilterMeasure measure) const;
  /// Standard error of mean_of_sequence: what the choice of seeds does to it. 0 for a single seed.
  double standard_error(std::size_t sequence, FilterMeasure measure) const;
};

/// Tracks one sequence with this number of particles and this seed.
using FilterSearch = std::function<Trace(const PreparedSequence&, int particles, std::uint64_t seed)>;

/// Seeds are first_seed, first_seed + 1, ... Runs are parallel; results do not depend on the number of cores.
FilterSweep sweep(std::span<const PreparedSequence> sequences, std::vector<int> particles,
                  std::uint64_t first_seed, std::size_t seeds, const PeakThresholds& peaks,
                  const FilterSearch& search);

/// Calls work(i) for all i below lengths.size() in parallel, the longest first, so that no core waits long
/// for the last one.
void longest_first(std::span<const double> lengths, const std::function<void(std::size_t)>& work);

}  // namespace telemime
