// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/budget.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

using Json = nlohmann::json;

bool positive(double x) {
  return std::isfinite(x) && x > 0.0;
}

// The best x on the line within [low, high]. z there is k0 + k1 x + k2 x^2.
double best_on_line(const QuadraticFit& fit, double alpha, double beta, double rho, double low, double high) {
  const double ratio = alpha / beta;
  const double most_y = rho / beta;
  const double k1 = fit.b - fit.c * ratio + fit.g * most_y - 2.0 * fit.f * most_y * ratio;
  const double k2 = fit.d + fit.f * ratio * ratio - fit.g * ratio;
  const auto z = [&](double x) { return k1 * x + k2 * x * x; };
  double best = high;  // regions win a tie
  const double stationary = k2 > 0.0 ? std::clamp(-k1 / (2.0 * k2), low, high) : low;
  for (const double x : {stationary, low}) {
    best = z(x) < z(best) ? x : best;
  }
  return best;
}

Json fit_json(const QuadraticFit& fit) {
  Json json = {{"A", fit.a}, {"B", fit.b}, {"C", fit.c}, {"D", fit.d}, {"F", fit.f}, {"G", fit.g}};
  if (std::isfinite(fit.limit)) {
    json["limit"] = fit.limit;
  }
  return json;
}

QuadraticFit fit_from_json(const Json& json) {
  QuadraticFit fit;
  fit.a = json.at("A").get<double>();
  fit.b = json.at("B").get<double>();
  fit.c = json.at("C").get<double>();
  fit.d = json.at("D").get<double>();
  fit.f = json.at("F").get<double>();
  fit.g = json.at("G").get<double>();
  fit.limit = json.value("limit", fit.limit);
  return fit;
}

}  // namespace

QuadraticFit default_fit() {
  return {
#include "budget_fit.inc"
  };
}

QuadraticFit fit_quadratic(std::span<const ErrorSample> samples) {
  QuadraticFit fit;
  fit.limit = 0.0;
  for (const ErrorSample& s : samples) {
    fit.limit = std::max({fit.limit, s.x, s.y});
  }
  if (samples.size() < 6 || !positive(fit.limit)) {
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

Allocation best_allocation(const QuadraticFit& fit, double alpha, double beta, double rho) {
  if (!positive(alpha) || !positive(beta) || !std::isfinite(rho) || rho < 0.0) {
    throw Error(ErrorKind::usage, "the cost of an evaluation must be above 0 and the budget not below");
  }
  const double most = (alpha + beta) * fit.limit;
  const double inside = std::min(rho, most);
  const double low = std::max(0.0, (inside - beta * fit.limit) / alpha);
  const double high = std::min(inside / alpha, fit.limit);
  const double x = best_on_line(fit, alpha, beta, inside, std::min(low, high), high);
  const double stretch = inside > 0.0 ? rho / inside : 1.0;
  return {x * stretch, std::max(0.0, (inside - alpha * x) / beta) * stretch};
}

Split split_for_budget(double budget_ms, double alpha_ms, double beta_ms, const QuadraticFit& fit) {
  const Allocation best = best_allocation(fit, alpha_ms, beta_ms, budget_ms);
  // Slightly more, so that 0.1 * 30 is still 3 after division and multiplication.
  constexpr double kRounding = 1e-9;
  constexpr double kMost = 1e6;
  Split split;
  split.region = static_cast<int>(std::min(kMost, std::floor(best.region + kRounding)));
  const double left = budget_ms - alpha_ms * split.region;
  split.edge = static_cast<int>(
      std::clamp(std::floor(left / beta_ms + kRounding), 0.0, std::min(kMost, std::ceil(best.edge))));
  return split;
}

EvaluationCost Tuning::cost_at(int width, int height) const {
  if (costs.empty()) {
    throw Error(ErrorKind::config, "the tuning holds no measured costs", "Run `telemime-lab tune` once.");
  }
  const auto distance = [&](const EvaluationCost& c) {
    return std::abs(static_cast<double>(c.width) * c.height - static_cast<double>(width) * height);
  };
  return *std::min_element(costs.begin(), costs.end(), [&](const EvaluationCost& p, const EvaluationCost& q) {
    return distance(p) < distance(q);
  });
}

Tuning read_tuning(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) {
    throw Error(ErrorKind::config, "budget file " + file.string() + " cannot be opened",
                "`telemime-lab tune --out FILE` writes one.");
  }
  try {
    const Json json = Json::parse(in);
    Tuning tuning;
    tuning.fit = fit_from_json(json.at("fit"));
    for (const Json& entry : json.value("costs", Json::array())) {
      EvaluationCost cost;
      cost.width = entry.at("width").get<int>();
      cost.height = entry.at("height").get<int>();
      cost.region_ms = entry.at("alpha_ms").get<double>();
      cost.edge_ms = entry.at("beta_ms").get<double>();
      if (cost.width < 1 || cost.height < 1 || !positive(cost.region_ms) || !positive(cost.edge_ms)) {
        throw Error(ErrorKind::config, "budget file " + file.string() + ": sizes and costs must be positive");
      }
      tuning.costs.push_back(cost);
    }
    if (!positive(tuning.fit.limit) && !std::isinf(tuning.fit.limit)) {
      throw Error(ErrorKind::config, "budget file " + file.string() + ": fit.limit must be positive");
    }
    return tuning;
  } catch (const Json::exception& e) {
    throw Error(ErrorKind::config, "budget file " + file.string() + ": " + e.what(),
                "`telemime-lab tune --out FILE` writes one.");
  }
}

std::string tuning_json(const Tuning& tuning, double budget_ms) {
  Json json;
  json["fit"] = fit_json(tuning.fit);
  json["costs"] = Json::array();
  for (const EvaluationCost& cost : tuning.costs) {
    Json entry = {{"width", cost.width},
                  {"height", cost.height},
                  {"alpha_ms", cost.region_ms},
                  {"beta_ms", cost.edge_ms}};
    if (budget_ms > 0.0) {
      const Split split = split_for_budget(budget_ms, cost.region_ms, cost.edge_ms, tuning.fit);
      entry["budget_ms"] = budget_ms;
      entry["region_iterations"] = split.region;
      entry["edge_iterations"] = split.edge;
    }
    json["costs"].push_back(entry);
  }
  return json.dump(2) + "\n";
}

}  // namespace telemime
