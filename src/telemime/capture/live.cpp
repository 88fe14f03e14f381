// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/live.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <opencv2/core.hpp>
#include <sstream>
#include <thread>
#include <utility>

#include "telemime/capture/picture.h"

namespace telemime {
namespace {

constexpr int most_damaged = 25;            // pictures in a row until the device is opened again
constexpr int first_picture_attempts = 20;  // some webcams hand out nothing while they warm up

class LiveSource : public Source {
 public:
  LiveSource(const std::string& name, OpenDevice open, LiveDevice device, const cv::Mat& first,
             LiveOptions options)
      : open_(std::move(open)), device_(std::move(device)), options_(std::move(options)) {
    info_ = {name, first.cols, first.rows, usable_fps(device_.fps, notes_), 0, /*live=*/true};
    start_ = options_.clock.now();
    newest_ = Frame{first, 0, 0.0, start_};
    reader_ = std::thread([this] { read(); });
  }

  ~LiveSource() override {
    stop();
    reader_.join();
  }

  void stop() override {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
  }

  const SourceInfo& info() const override { return info_; }

  std::string complaint() const override {
    const std::lock_guard lock(mutex_);
    Notes all = notes_;
    if (interruptions_ > 0) {
      std::ostringstream note;
      note.precision(1);
      note << std::fixed << "it stopped "
           << (interruptions_ == 1 ? "once" : std::to_string(interruptions_) + " times") << ", last after "
           << stopped_at_ << " s; " << outcome_;
      all.add(note.str());
    }
    if (all_damaged_ > 0) {
      all.add(std::to_string(all_damaged_) + " damaged pictures were left out");
    }
    return all.text();
  }

  std::optional<Frame> next() override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return newest_ || ended_ || stop_; });
    return stop_ ? std::nullopt : std::exchange(newest_, std::nullopt);
  }

 private:
  void read() {
    while (!stopped()) {
      if (!read_one() && !stopped() && !reopen()) {
        break;
      }
    }
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
  }

  /// False when the device has stopped, or gives nothing but damage.
  bool read_one() {
    cv::Mat picture;  // a new one each time: the last may still be in use
    try {
      if (!device_.grab(picture)) {
        return false;
      }
      publish(to_bgr8(picture));
      damaged_ = 0;
    } catch (const cv::Exception&) {  // of the decoder; the next picture may be whole
      damaged_ = (damaged_ + 1) % most_damaged;
      const std::lock_guard lock(mutex_);
      ++all_damaged_;
      return damaged_ != 0;
    }
    return true;
  }

  void publish(const cv::Mat& picture) {
    if (picture.empty()) {
      return;
    }
    failed_attempts_ = 0;
    const double taken = options_.clock.now();
    {
      const std::lock_guard lock(mutex_);
      newest_ = Frame{fit_to(picture, {info_.width, info_.height}, notes_), ++index_, taken - start_, taken};
    }
    changed_.notify_all();
  }

  /// Tries to open the device again, with growing pauses. False: given up, or asked to stop.
  bool reopen() {
    device_ = {};  // closes it; most drivers refuse a second opening
    const double stopped_at = options_.clock.now() - start_;
    while (failed_attempts_ < options_.pauses.size()) {
      if (!pause(options_.pauses[failed_attempts_])) {
        return false;
      }
      ++failed_attempts_;
      device_ = open_();
      if (device_.grab) {
        note_interruption(stopped_at, "it was opened again");
        return true;
      }
    }
    note_interruption(stopped_at,
                      "it did not come back in " + std::to_string(options_.pauses.size()) + " attempts");
    return false;
  }

  void note_interruption(double when, const std::string& outcome) {
    const std::lock_guard lock(mutex_);
    ++interruptions_;
    stopped_at_ = when;
    outcome_ = outcome;
  }

  /// False when the source is being destroyed.
  bool pause(double seconds) {
    std::unique_lock lock(mutex_);
    return !changed_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return stop_; });
  }

  bool stopped() const {
    const std::lock_guard lock(mutex_);
    return stop_;
  }

  // Only the reader's thread touches these once it runs.
  OpenDevice open_;
  LiveDevice device_;
  std::size_t failed_attempts_ = 0;
  std::int64_t index_ = 0;
  int damaged_ = 0;  // pictures in a row

  // Constant once the reader's thread runs.
  LiveOptions options_;
  SourceInfo info_;
  double start_ = 0.0;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Notes notes_;
  int interruptions_ = 0;
  std::int64_t all_damaged_ = 0;
  double stopped_at_ = 0.0;  // seconds, of the last interruption
  std::string outcome_;      // of the last interruption
  std::optional<Frame> newest_;
  bool ended_ = false;
  bool stop_ = false;

  std::thread reader_;
};

cv::Mat first_picture(const Grab& grab) {
  for (int attempt = 0; attempt < first_picture_attempts; ++attempt) {
    cv::Mat picture;
    try {
      if (grab(picture)) {
        cv::Mat usable = to_bgr8(picture);
        if (!usable.empty()) {
          return usable;
        }
      }
    } catch (const cv::Exception&) {  // of the decoder: the next one may be whole
      continue;
    }
  }
  return {};
}

}  // namespace

std::unique_ptr<Source> live_source(const std::string& name, OpenDevice open, LiveOptions options) {
  LiveDevice device = open();
  if (!device.grab) {
    return nullptr;
  }
  const cv::Mat first = first_picture(device.grab);
  if (first.empty()) {
    return nullptr;
  }
  require_usable_size(first.size(), name);
  return std::make_unique<LiveSource>(name, std::move(open), std::move(device), first, std::move(options));
}

}  // namespace telemime
