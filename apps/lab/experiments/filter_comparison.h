// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/experiments/lab.h"
#include "lab/experiments/report.h"

namespace telemime {

/// A quantity of the figures of thesis chapter 4.
struct FilterQuantity {
  FilterMeasure measure;
  const char* title;  ///< with its unit
};
inline constexpr FilterQuantity kError3d = {&FilterRun::error_3d, "mean 3-D error (mm)"};
inline constexpr FilterQuantity kMistracked = {&FilterRun::mistracked, "mistracked frames"};

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

/// "raising_arms 120 -> 100 (down), ...; mean ...".
std::string described_change(Lab& lab, const FilterAverages& from, const FilterAverages& to);

/// Tables of several filters (Lab::filter) beside each other: averages, by number of particles (mean and each
/// gesture, with the spread over the seeds), and effort.
Finding compare_filters(Lab& lab, const std::vector<std::string>& filters, const FilterQuantity& quantity);

}  // namespace telemime
