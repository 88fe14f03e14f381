// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_statistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace telemime {
namespace {

constexpr std::size_t kFrames = 100;
constexpr std::size_t kLatencies = 250;
constexpr double kStopped = 2.0;         // s without a frame
constexpr double kLongestLatency = 1e4;  // ms

}  // namespace

double quantile_of(std::vector<double> values, double q) {
  if (values.empty()) {
    return 0.0;
  }
  const double place = std::clamp(q, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::lround(place));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void InputRate::add(std::int64_t index, double time) {
  if (last_ < 0 || time < last_time_ || time - last_time_ > kStopped) {
    first_ = index;
    first_time_ = time;
  }
  last_ = index;
  last_time_ = time;
}

double InputRate::believable(double stated) const {
  constexpr std::int64_t kFewest = 3;  // frames, and seconds, before their rate is known
  constexpr double kShortest = 0.5;
  if (last_ - first_ < kFewest || last_time_ - first_time_ <= kShortest) {
    return stated;
  }
  const double rate = static_cast<double>(last_ - first_) / (last_time_ - first_time_);
  return rate < 0.5 * stated || rate > 1.1 * stated ? rate : stated;
}

bool falls_behind(const FrameTimes& now, FrameTimes& before) {
  const auto frames = static_cast<double>(now.index - before.index);
  const bool late = frames > 0.0 && now.seen - now.begun > (now.taken - before.taken) / frames;
  before = now;
  return late;
}

double usable_stamp(double taken, double last, double now) {
  constexpr double kOldest = 10.0;                             // s: no frame waits so long
  const bool usable = taken <= now && now - taken <= kOldest;  // neither of a NaN
  return std::max(usable ? taken : now, last);
}

void LiveStatistics::add(const FrameTimes& times) {
  if (!last_.empty()) {
    const std::int64_t came = std::max<std::int64_t>(1, times.index - last_.back().index);
    dropped_ += came - 1;
    // Not for a tracker that is slow: other pictures came in that time.
    if (times.taken - last_.back().taken >= kStopped * static_cast<double>(came)) {
      last_.clear();
    }
  }
  ++frames_;
  last_.push_back(times);
  if (last_.size() > kFrames) {
    last_.pop_front();
  }
}

void LiveStatistics::clear() {
  last_.clear();
}

LiveRates LiveStatistics::rates(double now) const {
  LiveRates rates;
  rates.frames = frames_;
  rates.dropped = dropped_;
  if (last_.empty()) {
    return rates;
  }
  const double span = last_.back().taken - last_.front().taken;
  if (span > 0.0 && now - last_.back().taken < kStopped) {
    rates.input = static_cast<double>(last_.back().index - last_.front().index) / span;
    rates.tracked = static_cast<double>(last_.size() - 1) / span;
  }
  const auto times = [this](const auto& ms_of) {
    std::vector<double> values;
    std::transform(last_.begin(), last_.end(), std::back_inserter(values), ms_of);
    return values;
  };
  // The median, of the means of two frames each: every second one has a new person mask and takes longer.
  const auto median = [&times](const auto& ms_of) {
    std::vector<double> values = times(ms_of);
    if (values.size() > 1) {
      std::transform(values.begin(), values.end() - 1, values.begin() + 1, values.begin(),
                     [](double a, double b) { return 0.5 * (a + b); });
      values.pop_back();
    }
    return quantile_of(std::move(values), 0.5);
  };
  const auto between = [](double FrameTimes::*from, double FrameTimes::*to) {
    return [from, to](const FrameTimes& t) { return 1000.0 * (t.*to - t.*from); };
  };
  rates.ms.networks = median([](const FrameTimes& t) { return t.networks_ms; });
  rates.ms.wait = median(between(&FrameTimes::taken, &FrameTimes::begun));
  rates.ms.features = median(between(&FrameTimes::begun, &FrameTimes::seen));
  rates.ms.queue = median(between(&FrameTimes::seen, &FrameTimes::searched));
  rates.ms.search = median(between(&FrameTimes::searched, &FrameTimes::decided));
  rates.ms.total = median(between(&FrameTimes::taken, &FrameTimes::decided));
  rates.ms.total_p95 = quantile_of(times(between(&FrameTimes::taken, &FrameTimes::decided)), 0.95);
  return rates;
}

void LatencyRecord::add(double ms) {
  if (!(ms >= 0.0 && ms <= kLongestLatency)) {
    return;
  }
  last_.push_back(ms);
  if (last_.size() > kLatencies) {
    last_.pop_front();
  }
}

std::optional<LatencyRecord::Summary> LatencyRecord::summary() const {
  if (last_.empty()) {
    return std::nullopt;
  }
  const std::vector<double> values(last_.begin(), last_.end());
  return Summary{quantile_of(values, 0.5), quantile_of(values, 0.95)};
}

}  // namespace telemime
