// SPDX-License-Identifier: Apache-2.0
// How the coefficients of search/budget.h are found and written down.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "telemime/search/budget.h"

namespace telemime {

/// One measurement: the error after x region and y edge evaluations.
struct ErrorSample {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;  ///< mm
};

/// Least-squares fit; `limit` becomes the largest x or y. Throws Error(usage) unless the samples determine
/// all six coefficients.
QuadraticFit fit_quadratic(std::span<const ErrorSample> samples);

/// Reads the fit of data/budget.json or of tuning_json(). Throws Error(config) that names the file and what
/// is wrong.
QuadraticFit read_fit(const std::filesystem::path& file);

/// Fit and costs as JSON text; with `budget_ms` > 0 also the split for each size.
std::string tuning_json(const QuadraticFit& fit, std::span<const EvaluationCost> costs = {},
                        double budget_ms = 0.0);

}  // namespace telemime
