// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/playback.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <utility>

#include "telemime/capture/cameras.h"
#include "telemime/capture/input_kind.h"

namespace telemime {
namespace {

constexpr double kMostReading = 1.0;  // s, to find the newest frame

class LoopedSource : public Source {
 public:
  explicit LoopedSource(std::function<std::unique_ptr<Source>()> open)
      : open_(std::move(open)), file_(open_()), info_(file_->info()) {
    info_.frames = 0;
  }

  const SourceInfo& info() const override { return info_; }
  std::string complaint() const override { return complaint_.empty() ? file_->complaint() : complaint_; }

  std::optional<Frame> next() override {
    std::optional<Frame> frame = file_->next();
    if (!frame && count_ > 0) {
      frame = again();
    }
    if (frame) {
      frame->time += passed_;
      last_ = frame->time;
      frame->index = count_++;
    }
    return frame;
  }

 private:
  std::optional<Frame> again() {
    try {
      file_ = open_();
    } catch (const Error& e) {
      complaint_ = e.what();
      return std::nullopt;
    }
    passed_ = last_ + 1.0 / info_.fps;
    return file_->next();
  }

  std::function<std::unique_ptr<Source>()> open_;
  std::unique_ptr<Source> file_;
  SourceInfo info_;
  std::string complaint_;
  double passed_ = 0.0;  // s, at the first frame of this repetition
  double last_ = 0.0;
  std::int64_t count_ = 0;
};

class PacedSource : public Source {
 public:
  PacedSource(std::unique_ptr<Source> file, Clock clock)
      : file_(std::move(file)), clock_(std::move(clock)), info_(file_->info()) {
    info_.live = true;
  }

  const SourceInfo& info() const override { return info_; }
  std::string complaint() const override { return file_->complaint(); }

  void stop() override {
    stopped_ = true;
    file_->stop();
  }
  void attend(std::function<void(const SourceNews&)> tell) override { file_->attend(std::move(tell)); }

  std::optional<Frame> next() override {
    if (!start_) {
      start_ = clock_.now();
      upcoming_ = file_->next();
    }
    if (!upcoming_) {
      return std::nullopt;
    }
    // A file may pause for long: in small steps, so that it can be stopped.
    constexpr double kStep = 0.1;  // s
    const double due = *start_ + upcoming_->time;
    for (double now = clock_.now(); now < due && !stopped_; now = clock_.now()) {
      clock_.wait_until(std::min(due, now + kStep));
    }
    if (stopped_) {
      return std::nullopt;
    }
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
  std::atomic<bool> stopped_ = false;
};

}  // namespace

std::unique_ptr<Source> loop(std::function<std::unique_ptr<Source>()> open) {
  return std::make_unique<LoopedSource>(std::move(open));
}

std::unique_ptr<Source> pace(std::unique_ptr<Source> file, Clock clock) {
  return std::make_unique<PacedSource>(std::move(file), std::move(clock));
}

LiveInput open_live_input(const std::string& named, const LiveOptions& options, bool repeat) {
  const std::string input = with_camera_found(named, [] { return list_cameras(); });
  if (repeat) {
    const InputKind kind = input_kind(input);
    if (kind == InputKind::camera || kind == InputKind::device || kind == InputKind::stream) {
      throw Error(ErrorKind::usage, shown_url(input) + " is not a file: it cannot be repeated",
                  "Omit --loop.");
    }
    return {.source = pace(loop([input, known = options.input] { return open_source(input, known); }))};
  }
  auto source = open_source(input, options);
  const bool camera = source->info().live;
  return {.source = camera ? std::move(source) : pace(std::move(source)), .camera = camera};
}

}  // namespace telemime
