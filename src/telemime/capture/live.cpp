// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/live.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <opencv2/core.hpp>
#include <optional>
#include <thread>
#include <utility>

#include "telemime/capture/camera_watch.h"
#include "telemime/capture/picture.h"

namespace telemime {
namespace {

constexpr int kMostDamaged = 25;           // consecutive images until the device is opened again
constexpr int kFirstPictureAttempts = 20;  // some webcams deliver nothing while they warm up
constexpr double kOldestStamp = 1.0;       // s; an older time stamp of the driver is of another clock

using Tell = std::function<void(const SourceNews&)>;

std::chrono::duration<double> in_seconds(double s) {
  return std::chrono::duration<double>(s);
}

/// What the reader's thread and the source share; the thread may outlive the source.
class Reader {
 public:
  Reader(OpenDevice open, LiveDevice device, const cv::Mat& first, LiveOptions options)
      : open_(std::move(open)),
        device_(std::move(device)),
        options_(std::move(options)),
        size_(first.size()),
        start_(options_.clock.now()),
        taken_(start_),
        opened_(start_),
        watch_(size_, start_) {
    fps_ = usable_fps(device_.fps, std::nullopt, notes_);
    newest_ = Frame{first, 0, 0.0, start_};
  }

  double fps() const { return fps_; }

  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
  }

  /// False if the thread is still running after this time.
  bool wait_for_end(double seconds) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, in_seconds(seconds), [this] { return ended_; });
  }

  void attend(Tell tell) {
    {
      const std::lock_guard lock(mutex_);
      tell_ = std::move(tell);
    }
    changed_.notify_all();
  }

  std::string complaint() const {
    const std::lock_guard lock(mutex_);
    Notes all = notes_;
    if (const std::string summary = watch_.summary(); !summary.empty()) {
      all.add(summary);
    }
    return all.text();
  }

  std::optional<Frame> next() {
    std::unique_lock lock(mutex_);
    while (true) {
      const auto something = [this] { return newest_ || ended_ || stop_ || !news_.empty(); };
      if (!tell_) {
        changed_.wait(lock, something);
      } else if (!changed_.wait_for(lock, in_seconds(options_.silence), something)) {
        note(watch_.silent());
      }
      if (stop_) {
        return std::nullopt;
      }
      if (!news_.empty()) {
        const auto news = std::exchange(news_, {});
        lock.unlock();
        for (const SourceNews& one : news) {
          tell_(one);  // set once, before the first call of next()
        }
        lock.lock();
      } else if (newest_ || ended_) {
        return std::exchange(newest_, std::nullopt);
      }
    }
  }

  /// Function of the reader's thread.
  void read() {
    try {
      while (!stopped()) {
        if (!read_one() && !stopped() && !reopen()) {
          break;
        }
      }
    } catch (const std::exception& e) {  // for example out of memory; no one else could catch it
      fail(e.what());
    } catch (...) {
      fail("an unknown failure");
    }
    device_ = {};
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
  }

 private:
  void fail(const std::string& why) {
    const std::lock_guard lock(mutex_);
    notes_.add("reading it failed: " + why);
  }

  /// False if the device has stopped or delivers only damaged images.
  bool read_one() {
    try {
      if (!device_.grab()) {
        return false;
      }
      stamp();
    } catch (const cv::Exception&) {  // of the driver, which may work again once it is reopened
      return false;
    }
    cv::Size size;
    cv::Mat picture;  // a new one each time, because the last may still be in use
    try {
      cv::Mat read;
      if (device_.retrieve(read)) {
        picture = to_bgr8(read);
        size = picture.size();
        picture = picture.empty() ? picture : fitted(picture);
      }
    } catch (const cv::Exception&) {  // of the decoder; the next image may be intact
      picture.release();
    }
    if (picture.empty()) {
      damaged_ = (damaged_ + 1) % kMostDamaged;
      {
        const std::lock_guard lock(mutex_);
        note(watch_.damaged(options_.clock.now()));
      }
      changed_.notify_all();
      return damaged_ != 0;
    }
    damaged_ = 0;
    publish(picture, size);
    return true;
  }

  void stamp() {
    const double now = options_.clock.now();
    const double driver = device_.stamp ? device_.stamp() : now;
    const bool usable = driver > taken_ && driver <= now && now - driver < kOldestStamp;
    taken_ = std::max(taken_, usable ? driver : now);
  }

  /// Resized to the size of the first image.
  cv::Mat fitted(const cv::Mat& picture) {
    const std::lock_guard lock(mutex_);
    return fit_to(picture, size_, notes_);
  }

  /// `size`: its original size.
  void publish(const cv::Mat& picture, cv::Size size) {
    {
      const std::lock_guard lock(mutex_);
      if (!tell_ || taken_ - opened_ >= options_.steady) {
        attempts_ = 0;
      }
      note(watch_.back(taken_));
      note(watch_.size(size));
      note(watch_.rate(taken_));
      note(watch_.whole(taken_));
      newest_ = Frame{picture, ++index_, taken_ - start_, taken_};
    }
    changed_.notify_all();
  }

  /// Requires the lock.
  void note(std::optional<SourceNews> news) {
    if (tell_ && news) {
      news_.push_back(std::move(*news));
    }
  }

  /// Tries to open the device again, with growing pauses. False if it gave up or was stopped.
  bool reopen() {
    device_ = {};  // closes it; most drivers refuse a second opening
    {
      const std::lock_guard lock(mutex_);
      note(watch_.stopped(options_.clock.now()));
    }
    changed_.notify_all();
    while (const std::optional<double> wait = next_pause()) {
      if (!pause(*wait)) {
        return false;
      }
      ++attempts_;
      try {
        device_ = open_();
      } catch (const cv::Exception&) {  // a failed attempt
        device_ = {};
      }
      if (device_.grab) {
        opened_ = options_.clock.now();
        return true;
      }
    }
    const std::lock_guard lock(mutex_);
    watch_.given_up(options_.pauses.size());
    return false;
  }

  /// Empty if there is no further attempt.
  std::optional<double> next_pause() const {
    const std::vector<double>& pauses = options_.pauses;
    const std::lock_guard lock(mutex_);
    if (!tell_) {
      return attempts_ < pauses.size() ? std::optional(pauses[attempts_]) : std::nullopt;
    }
    const double longest = options_.longest_pause;
    return pauses.empty() ? longest : std::min(longest, pauses[std::min(attempts_, pauses.size() - 1)]);
  }

  /// Ends early if the source becomes attended, because its pauses are shorter then. False if it was stopped.
  bool pause(double seconds) {
    std::unique_lock lock(mutex_);
    const bool attended = tell_ != nullptr;
    changed_.wait_for(lock, in_seconds(seconds), [this, attended] { return stop_ || (tell_ && !attended); });
    return !stop_;
  }

  bool stopped() const {
    const std::lock_guard lock(mutex_);
    return stop_;
  }

  // Used by the reader's thread only, once it runs.
  OpenDevice open_;
  LiveDevice device_;
  std::size_t attempts_ = 0;
  std::int64_t index_ = 0;
  int damaged_ = 0;  // consecutive images

  // Constant once the reader's thread runs.
  LiveOptions options_;
  cv::Size size_;
  double fps_ = 0.0;
  double start_;  // time of the first image, s

  double taken_;   // time of the last image; reader's thread only
  double opened_;  // time at which the device was opened last; reader's thread only

  mutable std::mutex mutex_;  // guards the following members
  std::condition_variable changed_;
  CameraWatch watch_;
  Notes notes_;
  Tell tell_;
  std::vector<SourceNews> news_;
  std::optional<Frame> newest_;
  bool ended_ = false;
  bool stop_ = false;
};

class LiveSource final : public Source {
 public:
  LiveSource(const std::string& name, OpenDevice open, LiveDevice device, const cv::Mat& first,
             const LiveOptions& options)
      : farewell_(options.farewell),
        left_behind_(options.left_behind),
        reader_(std::make_shared<Reader>(std::move(open), std::move(device), first, options)),
        info_{name, first.cols, first.rows, reader_->fps(), 0, /*live=*/true},
        thread_([reader = reader_] { reader->read(); }) {}

  ~LiveSource() override {
    reader_->stop();
    if (reader_->wait_for_end(farewell_)) {
      thread_.join();
      return;
    }
    thread_.detach();  // a hanging driver or network; the thread ends by itself and shares nothing
    if (left_behind_) {
      left_behind_();
    }
  }

  const SourceInfo& info() const override { return info_; }
  std::optional<Frame> next() override { return reader_->next(); }
  void stop() override { reader_->stop(); }
  void attend(Tell tell) override { reader_->attend(std::move(tell)); }
  std::string complaint() const override { return reader_->complaint(); }

 private:
  double farewell_;
  std::function<void()> left_behind_;
  std::shared_ptr<Reader> reader_;
  SourceInfo info_;
  std::thread thread_;
};

// Each attempt of a device that hangs takes as long as the driver has patience: there are no further ones
// then.
cv::Mat first_picture(const LiveDevice& device, const LiveOptions& options) {
  const double begun = options.clock.now();
  for (int attempt = 0; attempt < kFirstPictureAttempts; ++attempt) {
    if (attempt > 0 && options.clock.now() - begun > options.patience) {
      break;
    }
    try {
      cv::Mat picture;
      if (device.grab() && device.retrieve(picture)) {
        cv::Mat usable = to_bgr8(picture);
        if (!usable.empty()) {
          return usable;
        }
      }
    } catch (const cv::Exception&) {  // of the decoder; the next one may be intact
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
  const cv::Mat first = first_picture(device, options);
  if (first.empty()) {
    return nullptr;
  }
  require_usable_size(first.size(), name);
  return std::make_unique<LiveSource>(name, std::move(open), std::move(device), first, options);
}

}  // namespace telemime
