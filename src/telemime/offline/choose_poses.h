// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "telemime/offline/record_queue.h"

namespace telemime {

/// What `choose_poses` carries from window to window.
struct WindowState {
  explicit WindowState(const Config& config);

  Random seeds;
  std::optional<Pose> before;  ///< pose of the frame before the first undecided one, where it was tracked
  double before_time = 0.0;    ///< of that frame, s
};

/// Decides about poses with what comes after them, too (the setting `offline`): a second particle filter runs
/// backward in time over each window of TrajectoryConfig::stretch and overlap, and best_trajectory()
/// chooses among what both filters found. `last`: no frame of the same person follows, so that shorter
/// windows are decided, too. Without Config::look_back every record passes unchanged. The same seed gives the
/// same result for any number of threads.
void choose_poses(const Tracker& tracker, const Model& model, bool last, WindowState& window,
                  RecordQueue& queue);

/// Leaves the records that wait for `choose_poses` with the poses of the forward filter.
void keep_forward_poses(RecordQueue& queue);

}  // namespace telemime
