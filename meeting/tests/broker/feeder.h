// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "telemime/outputs/testing_motion.h"
#include "telemime/streaming/sender.h"

namespace telemime::meeting::test_support {

/// A camera and its person: sends a hundred frames per second until it ends.
class Feeder {
 public:
  explicit Feeder(Sender& sender) : sender_(sender) {
    sender_.begin(header_);
    thread_ = std::thread([this] { run(); });
  }
  Feeder(const Feeder&) = delete;
  Feeder& operator=(const Feeder&) = delete;
  ~Feeder() {
    stop_ = true;
    thread_.join();
  }

  /// The person stands still, or moves again.
  void stand_still(bool still) { still_ = still; }
  /// The person is lost, or found again.
  void lose(bool lost) { lost_ = lost; }

  const StreamHeader& header() const { return header_; }
  const std::vector<MotionFrame>& frames() const { return frames_; }

 private:
  void run() {
    auto next = std::chrono::steady_clock::now();
    for (std::size_t i = 0; !stop_; i += still_ ? 0 : 1) {
      MotionFrame frame = frames_[i % frames_.size()];
      frame.state = lost_ ? TrackState::lost : TrackState::tracking;
      const std::chrono::duration<double, std::milli> now =
          std::chrono::steady_clock::now().time_since_epoch();
      sender_.send(frame, now.count());
      next += std::chrono::milliseconds(10);
      std::this_thread::sleep_until(next);
    }
  }

  Sender& sender_;
  StreamHeader header_ = testing_motion::header();
  // A fast gesture: two consecutive frames always differ.
  std::vector<MotionFrame> frames_ = testing_motion::gesture(header_, 100, /*period=*/4.0);
  std::atomic<bool> still_ = false;
  std::atomic<bool> lost_ = false;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace telemime::meeting::test_support
