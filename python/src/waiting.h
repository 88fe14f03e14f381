// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "frame.h"

namespace telemime::python {

/// Frames on their way from the threads of a run to Python.
class FrameQueue {
 public:
  /// `newest_only`: a new frame takes the place of one that waits. Otherwise at most a few wait, and put()
  /// waits for Python.
  explicit FrameQueue(bool newest_only) : newest_only_(newest_only) {}

  void put(FramePointer frame) {
    std::unique_lock lock(mutex_);
    if (newest_only_) {
      frames_.clear();
    } else {
      constexpr std::size_t kMost = 16;
      changed_.wait(lock, [this] { return closed_ || frames_.size() < kMost; });
    }
    if (!closed_) {
      frames_.push_back(std::move(frame));
      changed_.notify_all();
    }
  }

  /// No frame follows: the run has ended, or nobody wants its frames any more.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

  /// The next frame; null when none has come within a short time, or after close().
  FramePointer take() {
    constexpr std::chrono::milliseconds kPatience{50};
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kPatience, [this] { return closed_ || !frames_.empty(); });
    if (frames_.empty()) {
      return nullptr;
    }
    FramePointer frame = std::move(frames_.front());
    frames_.pop_front();
    changed_.notify_all();
    return frame;
  }

  bool closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }

 private:
  const bool newest_only_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<FramePointer> frames_;
  bool closed_ = false;
};

/// The next frame for Python, whose other threads run meanwhile; Ctrl-C ends the wait. Null after `ended()`.
template <typename Ended>
FramePointer wait_for_frame(FrameQueue& queue, const Ended& ended) {
  while (true) {
    FramePointer frame;
    bool last = false;
    {
      const pybind11::gil_scoped_release others;
      last = ended();  // before the queue is looked into: what came until then is in it
      frame = queue.take();
    }
    if (frame || last) {
      return frame;
    }
    if (PyErr_CheckSignals() != 0) {
      throw pybind11::error_already_set();
    }
  }
}

}  // namespace telemime::python
