// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/time_base.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace telemime {
namespace {

constexpr std::array kUsualRates = {5.0,  10.0, 12.5, 15.0, 20.0,       24e3 / 1001, 24.0,  25.0, 3e4 / 1001,
                                    30.0, 48.0, 50.0, 60.0, 6e4 / 1001, 100.0,       120.0, 240.0};
constexpr double kExact = 0.05;           // of 1/25 s: time stamps of cameras are not more exact
constexpr double kLeastStep = 1e-6;       // s; no camera is as fast
constexpr double kPause = 0.5;            // s; no step of a usual rate
constexpr double kLongestPause = 3600.0;  // s
constexpr double kLastPause = 60.0;       // s; a longer one that no further frame confirms is none
constexpr double kDisorder = 0.5;         // s; a larger jump back is a new beginning
constexpr double kInstant = 1e-3;         // s

double rounded_rate(double rate) {
  const double usual = *std::min_element(kUsualRates.begin(), kUsualRates.end(), [rate](double a, double b) {
    return std::abs(a - rate) < std::abs(b - rate);
  });
  return std::abs(usual / rate - 1.0) < 0.01 ? usual : rate;
}

}  // namespace

double units_between(double before, double now) {
  const double units = kUnitsPerSecond * (now - before);
  return std::abs(units - 1.0) < kExact || !(units > 0.0) ? 1.0 : units;
}

std::optional<double> time_since(std::optional<double> before, bool is_one, double elapsed) {
  if (!is_one) {
    return std::nullopt;
  }
  return before ? *before + elapsed : 0.0;
}

std::optional<double> rate_of(const std::vector<double>& stamps) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const double step = stamps[i] - stamps[i - 1];
    if (step > kLeastStep && step < kLongestPause) {
      steps.push_back(step);
    }
  }
  if (steps.size() < 2) {
    return std::nullopt;
  }
  std::vector<double> sorted = steps;
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted[sorted.size() / 2];
  const auto mean_within = [&](double least, double most) {
    const auto first = std::lower_bound(sorted.begin(), sorted.end(), least);
    const auto last = std::upper_bound(first, sorted.end(), most);
    return std::pair(std::accumulate(first, last, 0.0) / static_cast<double>(last - first), last - first);
  };
  const double mean = mean_within(0.0, std::max(kPause, 10.0 * median)).first;
  // About the median, and as far from it as rounding to milliseconds goes.
  const auto [usual, count] =
      mean_within(0.94 * median - kInstant, std::min(1.06 * median + kInstant, 1.9 * median));
  const bool regular = 2 * count > std::ssize(sorted) && mean < 2.0 * usual;
  return rounded_rate(1.0 / (regular ? usual : mean));
}

bool same_rate(double a, double b) {
  return std::abs(a / b - 1.0) < 0.02;
}

bool TimeBase::is_wrong(double time, std::optional<double> following) const {
  if (!following || !std::isfinite(*following)) {
    return time > time_ + kLastPause;
  }
  const double next = *following - *start_;
  const bool ahead = time > time_ + kPause && next < time - kDisorder;
  const bool behind = time < time_ - kDisorder;
  return (ahead || behind) && next > time_ - kDisorder && next < time_ + kLongestPause;
}

double TimeBase::next(std::optional<double> stamp, std::optional<double> following) {
  const bool first = time_ < 0.0;
  const double expected = first ? 0.0 : time_ + step_;
  if (!stamp || !std::isfinite(*stamp)) {
    return time_ = expected;
  }
  const double time = start_ ? *stamp - *start_ : expected;
  if (start_ && is_wrong(time, following)) {
    return time_ = expected;
  }
  if (!start_ || time < time_ - kDisorder || time > time_ + kLongestPause) {
    start_ = *stamp - expected;
    return time_ = expected;
  }
  return time_ = std::max(time, time_ + std::min(kInstant, 0.1 * step_));
}

}  // namespace telemime
