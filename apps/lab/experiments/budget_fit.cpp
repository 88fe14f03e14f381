// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/budget_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

using Json = nlohmann::json;

constexpr std::array<std::pair<const char*, double QuadraticFit::*>, 6> kCoefficients = {
    {{"A", &QuadraticFit::a},
     {"B", &QuadraticFit::b},
     {"C", &QuadraticFit::c},
     {"D", &QuadraticFit::d},
     {"F", &QuadraticFit::f},
     {"G", &QuadraticFit::g}}};

}  // namespace

QuadraticFit fit_quadratic(std::span<const ErrorSample> samples) {
  QuadraticFit fit;
  fit.limit = 0.0;
  for (const ErrorSample& s : samples) {
    fit.limit = std::max({fit.limit, s.x, s.y});
  }
  if (samples.size() < 6 || !std::isfinite(fit.limit) || fit.limit <= 0.0) {
    throw Error(ErrorKind::usage, "a quadratic of two variables needs at least 6 different samples");
  }
  // In units of the limit, so that the columns are of one size.
  const double unit = fit.limit;
  const auto rows = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd terms(rows, 6);
  Eigen::VectorXd values(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const ErrorSample& s = samples[static_cast<std::size_t>(i)];
    const double x = s.x / unit;
    const double y = s.y / unit;
    terms.row(i) << 1.0, x, y, x * x, y * y, x * y;
    values[i] = s.z;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(terms);
  if (qr.rank() < 6 || !values.allFinite()) {
    throw Error(ErrorKind::usage, "the samples do not determine a quadratic of two variables",
                "Measure at least three different numbers of each kind of evaluation.");
  }
  const Eigen::VectorXd k = qr.solve(values);
  fit.a = k[0];
  fit.b = k[1] / unit;
  fit.c = k[2] / unit;
  fit.d = k[3] / (unit * unit);
  fit.f = k[4] / (unit * unit);
  fit.g = k[5] / (unit * unit);
  return fit;
}

QuadraticFit read_fit(const std::filesystem::path& file) {
  const auto fail = [&file](const std::string& what) {
    return Error(ErrorKind::config, "budget file " + file.string() + " " + what,
                 "`telemime-lab tune --out FILE` writes one.");
  };
  std::ifstream in(file);
  if (!in) {
    throw fail("cannot be opened");
  }
  QuadraticFit fit;
  try {
    const Json json = Json::parse(in).at("fit");
    for (const auto& [name, member] : kCoefficients) {
      fit.*member = json.at(name).get<double>();
    }
    fit.limit = json.value("limit", fit.limit);
  } catch (const Json::exception& e) {
    throw fail(std::string("cannot be used: ") + e.what());
  }
  if (!(fit.limit > 0.0)) {
    throw fail("has a limit that is not positive");
  }
  return fit;
}

std::string tuning_json(const QuadraticFit& fit, std::span<const EvaluationCost> costs, double budget_ms) {
  Json json = {{"costs", Json::array()}};
  for (const auto& [name, member] : kCoefficients) {
    json["fit"][name] = fit.*member;
  }
  if (std::isfinite(fit.limit)) {
    json["fit"]["limit"] = fit.limit;
  }
  for (const EvaluationCost& cost : costs) {
    Json entry = {{"width", cost.width},
                  {"height", cost.height},
                  {"alpha_ms", cost.region_ms},
                  {"beta_ms", cost.edge_ms}};
    if (budget_ms > 0.0) {
      const Split split = split_for_budget(budget_ms, cost.region_ms, cost.edge_ms, fit);
      entry["budget_ms"] = budget_ms;
      entry["region_iterations"] = split.region;
      entry["edge_iterations"] = split.edge;
    }
    json["costs"].push_back(entry);
  }
  return json.dump(2) + "\n";
}

}  // namespace telemime
