// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

#include "telemime/live/live_session.h"

namespace telemime::live_testing {

// The thread sanitizer makes the search some fifty times slower.
#ifdef __SANITIZE_THREAD__
inline constexpr std::chrono::minutes kPatience{5};
#else
inline constexpr std::chrono::minutes kPatience{1};
#endif

/// Records the calls of a session's hooks, and waits for them.
class SessionEvents {
 public:
  LiveHooks hooks() {
    LiveHooks hooks;
    hooks.motion = [this](const MotionFrame& frame, double when) {
      note([&] {
        motion.push_back(frame);
        taken.push_back(when);
      });
    };
    hooks.person = [this](const StreamHeader&) { note([&] { ++persons; }); };
    hooks.picture = [this](const Frame&) { note([&] { ++pictures; }); };
    hooks.message = [this](MessageLevel, const std::string& words) {
      note([&] { messages += words + "\n"; });
    };
    return hooks;
  }
  /// Waits until `done()`; false after kPatience.
  template <typename Done>
  bool wait(const Done& done) {
    std::unique_lock lock(mutex_);
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (!done()) {
      if (changed_.wait_until(
              lock, std::min(deadline, std::chrono::steady_clock::now() + std::chrono::milliseconds(5))) ==
              std::cv_status::timeout &&
          std::chrono::steady_clock::now() > deadline) {
        return false;
      }
    }
    return true;
  }

  std::vector<MotionFrame> motion;
  std::vector<double> taken;  ///< times of the same frames
  int persons = 0;
  int pictures = 0;
  std::string messages;

 private:
  template <typename Change>
  void note(const Change& change) {
    {
      const std::lock_guard lock(mutex_);
      change();
    }
    changed_.notify_all();
  }
  std::mutex mutex_;
  std::condition_variable changed_;
};

}  // namespace telemime::live_testing
