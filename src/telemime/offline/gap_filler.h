// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>

#include "telemime/offline/offline.h"
#include "telemime/tracker/tracker.h"

namespace telemime {

/// A frame on its way through GapFiller.
struct GapFrame {
  OfflineFrame decided;
  /// Of a frame in which somebody is seen but not tracked; else nothing.
  std::optional<PreparedFrame> seen;
};

/// Follows somebody who was found in a file back through the frames in which they were seen but not tracked:
/// who walks in sideways, or bends over a chair, is hard to find but not hard to follow. A particle filter
/// runs backward in time from where they were found, until nobody is seen or the body no longer fits. Same
/// seed, same result.
class GapFiller {
 public:
  /// `tracker` must stay, and use a particle filter. At most TrackingConfig::fill_back frames wait,
  /// all of them with somebody seen.
  explicit GapFiller(const Tracker& tracker);

  /// `tracker` has just decided about the frame. Returns how many frames before it are tracked now, too.
  std::size_t push(GapFrame frame);
  /// No frame comes any more, or none of the same person: what waits stays lost.
  void finish() { decided_ = waiting_.size(); }
  /// The next frame, in the order in which they came; nothing when it must wait.
  std::optional<OfflineFrame> next();

 private:
  std::size_t fill();

  const Tracker& tracker_;
  Evaluators evaluators_;
  Random seeds_;
  std::deque<GapFrame> waiting_;
  std::size_t decided_ = 0;  ///< of the waiting frames, from the first on
};

}  // namespace telemime
