// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/hand_over.h"

#include <utility>

namespace telemime {

LiveSlot* HandOver::begin() {
  std::unique_lock lock(mutex_);
  // What is not taken yet is in the other slot.
  changed_.wait(lock, [this] { return stop_ || finish_ || (ready_ == nullptr && (settled_ || !busy_)); });
  return stop_ || finish_ ? nullptr : &slots_.at(mine_);
}

void HandOver::give() {
  {
    const std::lock_guard lock(mutex_);
    ready_ = &slots_.at(mine_);
    mine_ = 1 - mine_;
  }
  changed_.notify_all();
}

bool HandOver::wait_for_search() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stop_ || finish_ || (ready_ == nullptr && !busy_); });
  return !stop_;
}

LiveSlot* HandOver::take() {
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

void HandOver::done(bool settled) {
  {
    const std::lock_guard lock(mutex_);
    settled_ = settled;
    busy_ = false;
  }
  changed_.notify_all();
}

bool HandOver::settled() const {
  const std::lock_guard lock(mutex_);
  return settled_;
}

void HandOver::set_settled(bool settled) {
  const std::lock_guard lock(mutex_);
  settled_ = settled;
}

void HandOver::finish() {
  {
    const std::lock_guard lock(mutex_);
    finish_ = true;
  }
  changed_.notify_all();
}

void HandOver::stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
}

bool HandOver::stopping() const {
  const std::lock_guard lock(mutex_);
  return stop_;
}

}  // namespace telemime
