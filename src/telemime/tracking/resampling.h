// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "telemime/core/random.h"

namespace telemime {

/// Children of each parent, drawn independently with probabilities in proportion to the weights
/// (CONDENSATION, thesis 4.2.3). `weights` are not negative and their sum is above 0; the result's sum is
/// `total`.
std::vector<int> multinomial_counts(std::span<const double> weights, int total, Random& random);

/// Children of each parent without a draw (thesis equation 4.14): total x weight rounded down, and what is
/// left goes to the largest fractions, the first of equals.
std::vector<int> proportional_counts(std::span<const double> weights, int total);

}  // namespace telemime
