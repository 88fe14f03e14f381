// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <condition_variable>
#include <mutex>
#include <optional>

#include "telemime/live/live_statistics.h"
#include "telemime/tracker/tracker.h"

namespace telemime {

/// A frame on its way from the image side's thread to the search side's.
struct LiveSlot {
  SeenFrame seen;
  FrameTimes times;
};

/// Hands frames from one thread to the other, one at a time: one is being looked at while another is being
/// searched, and none waits for longer than the work in hand.
class HandOver {
 public:
  /// Of the image side: a slot to fill, as soon as the one before was taken (and, until a person is settled,
  /// as soon as the search is done: it has a say in what the image side learns). Null when all is to stop.
  LiveSlot* begin();
  /// Of the image side: the slot of the last begin() is filled.
  void give();
  /// Of the image side: waits until the search has nothing to do; false when all is to stop.
  bool wait_for_search();

  /// Of the search side: the next filled slot; null when all is to stop.
  LiveSlot* take();
  /// Of the search side: what take() gave is dealt with.
  void done(bool settled);

  /// A person was calibrated, as done() said.
  bool settled() const;
  /// While the search has nothing to do: true for a person who was calibrated before, false when they are to
  /// be calibrated anew.
  void set_settled(bool settled);

  /// The input has ended, or one side has failed: what was given is dealt with, and then both stop.
  void finish();
  /// Both sides stop at once.
  void stop();
  bool stopping() const;  ///< stop() was called

 private:
  std::array<LiveSlot, 2> slots_;
  std::size_t mine_ = 0;  // of the image side

  mutable std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  LiveSlot* ready_ = nullptr;  // filled, and not yet taken
  bool busy_ = false;          // the search is at work
  bool settled_ = false;
  bool finish_ = false;
  bool stop_ = false;
};

}  // namespace telemime
