// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/frame_exchange.h"

#include <utility>

namespace telemime {

LiveSlot* FrameExchange::free_slot() {
  std::unique_lock lock(mutex_);
  // A slot that is not taken yet is the other one.
  changed_.wait(lock, [this] { return stop_ || finish_ || (ready_ == nullptr && (calibrated_ || !busy_)); });
  return stop_ || finish_ ? nullptr : &slots_.at(free_);
}

void FrameExchange::publish() {
  {
    const std::lock_guard lock(mutex_);
    ready_ = &slots_.at(free_);
    free_ = 1 - free_;
  }
  changed_.notify_all();
}

bool FrameExchange::wait_for_search() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stop_ || finish_ || (ready_ == nullptr && !busy_); });
  return !stop_;
}

LiveSlot* FrameExchange::take() {
  LiveSlot* slot = nullptr;
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stop_ || finish_ || ready_ != nullptr; });
    if (stop_ || ready_ == nullptr) {
      return nullptr;
    }
    slot = std::exchange(ready_, nullptr);
    busy_ = true;
  }
  changed_.notify_all();
  return slot;
}

void FrameExchange::done(bool calibrated) {
  {
    const std::lock_guard lock(mutex_);
    calibrated_ = calibrated;
    busy_ = false;
  }
  changed_.notify_all();
}

bool FrameExchange::calibrated() const {
  const std::lock_guard lock(mutex_);
  return calibrated_;
}

void FrameExchange::set_calibrated(bool calibrated) {
  const std::lock_guard lock(mutex_);
  calibrated_ = calibrated;
}

void FrameExchange::finish() {
  {
    const std::lock_guard lock(mutex_);
    finish_ = true;
  }
  changed_.notify_all();
}

void FrameExchange::stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
}

bool FrameExchange::stopping() const {
  const std::lock_guard lock(mutex_);
  return stop_;
}

}  // namespace telemime
