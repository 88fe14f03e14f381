// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/paced.h"

#include <utility>

namespace telemime {
namespace {

constexpr double kMostReading = 1.0;  // s, to find the newest frame

class PacedSource : public Source {
 public:
  PacedSource(std::unique_ptr<Source> file, Clock clock)
      : file_(std::move(file)), clock_(std::move(clock)), info_(file_->info()) {
    info_.live = true;
  }

  const SourceInfo& info() const override { return info_; }
  std::string complaint() const override { return file_->complaint(); }

  void stop() override { file_->stop(); }
  void attend(std::function<void(const SourceNews&)> tell) override { file_->attend(std::move(tell)); }

  std::optional<Frame> next() override {
    if (!start_) {
      start_ = clock_.now();
      upcoming_ = file_->next();
    }
    if (!upcoming_) {
      return std::nullopt;
    }
    clock_.wait_until(*start_ + upcoming_->time);
    const double began = clock_.now();
    const double elapsed = began - *start_;
    std::optional<Frame> newest;
    do {
      newest = std::exchange(upcoming_, file_->next());
    } while (upcoming_ && upcoming_->time <= elapsed && clock_.now() - began < kMostReading);
    newest->taken = *start_ + newest->time;
    if (upcoming_ && upcoming_->time <= elapsed) {
      // Reading cannot keep up, and dropping frames takes time, too: play the file more slowly.
      *start_ = clock_.now() - upcoming_->time;
    }
    return newest;
  }

 private:
  std::unique_ptr<Source> file_;
  Clock clock_;
  SourceInfo info_;
  std::optional<double> start_;    // seconds of the clock at the first frame
  std::optional<Frame> upcoming_;  // already read, not returned yet
};

}  // namespace

std::unique_ptr<Source> pace(std::unique_ptr<Source> file, Clock clock) {
  return std::make_unique<PacedSource>(std::move(file), std::move(clock));
}

}  // namespace telemime
