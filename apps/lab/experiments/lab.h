// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lab/experiments/budget_fit.h"
#include "lab/experiments/filter_sweep.h"
#include "lab/experiments/sequence.h"

namespace telemime {

struct LabOptions {
  std::filesystem::path data;  ///< holds raising_arms/, joy/, exclaiming/, asking/
  bool quick = false;          ///< few frames, coarse grids: a check that it runs
  std::uint64_t seed = 1;
  int seeds = 0;  ///< runs of a particle filter, each with a seed of its own; 0: 5, 2 when quick
  PeakThresholds peaks;
  std::function<void(const std::string&)> progress;  ///< receives progress messages; may be empty
  std::function<double()> seconds;                   ///< processor time of the calling thread, s
};

/// One cell of the grid: a sequence tracked with this many region and edge evaluations per frame.
struct GridCell {
  std::size_t sequence = 0;
  int region = 0;
  int edge = 0;
  double mean_region = 0.0;
  double mean_contour = 0.0;
  double region_peaks = 0.0;   ///< frames
  double contour_peaks = 0.0;  ///< frames
  double error_2d = 0.0;       ///< mm
  double error_3d = 0.0;       ///< mm
};

struct Grid {
  std::vector<double> steps;    ///< numbers of evaluations, the same for both
  std::vector<GridCell> cells;  ///< by sequence, then edge, then region
  /// Values of one sequence, by edge, then region.
  std::vector<double> plane(std::size_t sequence, double GridCell::*measure) const;
  /// Their mean over the sequences.
  std::vector<double> mean_plane(double GridCell::*measure) const;
};

/// Names for Lab::filter besides lists of heuristics of the thesis's filter.
inline constexpr const char* kCondensation = "";
inline constexpr const char* kAllTogether = "wd,hpm,lo,kf,ee";
inline constexpr const char* kOurFilter = "ours";

/// Shared state of the experiments. Clips and sequences are read and prepared on first use; the grid over the
/// iterations and each filter are tracked once.
class Lab {
 public:
  /// Throws Error(usage) without a clock.
  explicit Lab(LabOptions options);

  const LabOptions& options() const { return options_; }
  /// The four gestures at 160x120.
  const std::vector<PreparedSequence>& gestures();
  const PreparedSequence& gesture(const std::string& name);
  /// The clip that timings are made on.
  const Clip& timing_clip();
  const Grid& grid();
  /// The four gestures with a particle filter of 100 to 1000 particles: the thesis's with these heuristics,
  /// or ours.
  const FilterSweep& filter(const std::string& heuristics);
  /// The four gestures tracked by track(sequence, particles, seed).
  FilterSweep sweep_gestures(std::vector<int> particles,
                             const std::function<Trace(const PreparedSequence&, int, std::uint64_t)>& track);
  /// Runs of each particle filter.
  std::size_t seeds() const;
  /// Quadratic fit to the mean 2-D error over the gestures (thesis Figure 3-28).
  QuadraticFit fit() { return fit_quadratic(error_samples()); }
  /// That error by numbers of evaluations.
  std::vector<ErrorSample> error_samples();
  /// Evaluations after which a search counts as run to convergence.
  int to_convergence() const { return options_.quick ? 800 : 3000; }
  void log(const std::string& message) const;

 private:
  LabOptions options_;
  std::vector<PreparedSequence> gestures_;
  std::optional<Clip> clip_;
  std::optional<Grid> grid_;
  std::map<std::string, FilterSweep> filters_;
};

/// The filter that Lab::filter names.
FilterSetup filter_setup(const std::string& heuristics);

/// The filter's name in tables.
std::string filter_title(const std::string& heuristics);

/// The configuration that experiments prepare sequences with: 160x120, all else by default.
Config experiment_config(std::uint64_t seed);

/// Tracks one sequence with several searches in parallel; results do not depend on the number of cores.
std::vector<Trace> track_all(const PreparedSequence& sequence,
                             const std::vector<RegistrationConfig>& searches, std::uint64_t seed);

}  // namespace telemime
