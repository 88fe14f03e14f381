// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/resampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace telemime {

std::vector<int> multinomial_counts(std::span<const double> weights, int total, Random& random) {
  std::vector<double> cumulated(weights.size());
  std::partial_sum(weights.begin(), weights.end(), cumulated.begin());
  std::vector<int> counts(weights.size());
  for (int i = 0; i < total; ++i) {
    const double at = random.uniform() * cumulated.back();
    const auto parent = std::upper_bound(cumulated.begin(), cumulated.end(), at) - cumulated.begin();
    ++counts[std::min(static_cast<std::size_t>(parent), weights.size() - 1)];
  }
  return counts;
}

std::vector<int> proportional_counts(std::span<const double> weights, int total) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<int> counts(weights.size());
  std::vector<double> fraction(weights.size());
  int given = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double share = total * weights[i] / sum;
    counts[i] = static_cast<int>(std::floor(share));
    fraction[i] = share - counts[i];
    given += counts[i];
  }
  std::vector<std::size_t> order(weights.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return fraction[a] > fraction[b]; });
  for (std::size_t i = 0; given < total; i = (i + 1) % order.size()) {
    ++counts[order[i]];
    ++given;
  }
  return counts;
}

}  // namespace telemime
