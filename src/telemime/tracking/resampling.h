// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "telemime/core/random.h"

namespace telemime {

/// Number of children of each parent, drawn independently with probabilities proportional to the weights
/// (CONDENSATION, thesis 4.2.3); they sum to `total`. Weights must not be negative and their sum must be
/// above 0.
std::vector<int> multinomial_counts(std::span<const double> weights, int total, Random& random);

/// Number of children of each parent without random draws (thesis equation 4.14): total x weight rounded
/// down; the remainder goes to the largest fractions, of equals to the first.
std::vector<int> proportional_counts(std::span<const double> weights, int total);

}  // namespace telemime
