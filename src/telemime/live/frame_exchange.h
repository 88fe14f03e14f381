// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <condition_variable>
#include <mutex>

#include "telemime/live/live_statistics.h"
#include "telemime/tracker/track_frame.h"

namespace telemime {

/// A frame on its way from the image thread to the search thread.
struct LiveSlot {
  FrameRecord record;
  FrameTimes times;
};

/// Passes frames from the image thread to the search thread, one at a time: features of one frame are
/// extracted while another one is searched, and no frame waits longer than for the work in progress.
class FrameExchange {
 public:
  /// Image thread: a slot to fill, as soon as the previous one was taken and, until a person is calibrated,
  /// the search is done (it decides which colours are learned). Null if both threads must stop.
  LiveSlot* free_slot();
  /// Image thread: the slot of the last free_slot() is filled.
  void publish();
  /// Image thread: waits until the search is idle. False if both threads must stop.
  bool wait_for_search();

  /// Search thread: the next filled slot; null if both threads must stop.
  LiveSlot* take();
  /// Search thread: the slot of the last take() is free again.
  void done(bool calibrated);

  /// Whether a person is calibrated, as of the last done() or set_calibrated().
  bool calibrated() const;
  /// Only while the search is idle.
  void set_calibrated(bool calibrated);

  /// The input has ended, or one thread has failed: the published slot is still searched, then both stop.
  void finish();
  /// Both threads stop at once.
  void stop();
  bool stopping() const;  ///< stop() was called

 private:
  std::array<LiveSlot, 2> slots_;
  std::size_t free_ = 0;  ///< index; used only by the image thread

  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable changed_;
  LiveSlot* ready_ = nullptr;  ///< filled, and not yet taken
  bool busy_ = false;          ///< a search is in progress
  bool calibrated_ = false;
  bool finish_ = false;
  bool stop_ = false;
};

}  // namespace telemime
