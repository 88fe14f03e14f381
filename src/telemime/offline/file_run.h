// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "telemime/capture/source.h"
#include "telemime/offline/choose_poses.h"
#include "telemime/offline/fill_back.h"
#include "telemime/offline/run_outputs.h"
#include "telemime/offline/track_file.h"
#include "telemime/offline/two_way_smoothing.h"
#include "telemime/tracker/message_deduplicator.h"

namespace telemime {

/// Numbers over the frames of a run, for the report.
struct RunStatistics {
  std::int64_t frames = 0;
  std::int64_t tracked = 0;
  std::int64_t first_tracked = -1;
  double region = 0.0;       ///< sum of F
  double contour = 0.0;      ///< sum of D_C
  double evaluations = 0.0;  ///< sum
  std::map<std::string, std::vector<double>> stage_ms;

  void add(const MotionFrame& motion);
  nlohmann::json json() const;
};

/// The tracked frames of a file on their way into the output files: one queue of records, over which the
/// passes go in turn (backward fill, choice of poses, smoothing, writing).
class FileRun {
 public:
  /// All arguments must outlive the run. Throws Error(output), Error(usage), Error(config).
  FileRun(const TrackRequest& request, const RunHooks& hooks, const SourceInfo& info, const TrackingRun& run);

  /// Takes up the next frame: reports it, and lets every pass go as far as it can.
  ViewerRequest add(FrameRecord record);
  /// The frames that wait belong to the person who was followed until now.
  void end_person();
  /// Writes what waits and the report.
  TrackSummary finish(bool interrupted, const std::string& complaint,
                      const std::vector<std::string>& scene_messages);

  std::int64_t frames() const { return frames_; }
  /// Longest side of the pictures that are drawn, pixels; 0: none are.
  int picture_side() const;

 private:
  /// The person whose bones the joints have from now on; the outputs begin with the first.
  void begin();
  void write_early();
  void advance(bool last);
  void write_ready(bool last);
  void draw(const FrameRecord& record, const MotionFrame& motion);
  void note(const std::string& message);

  const TrackRequest& request_;
  const nlohmann::json asked_;  ///< request_json() before the frames are tracked
  const RunHooks& hooks_;
  const SourceInfo& info_;
  const TrackingRun& run_;
  MessageDeduplicator reported_;
  nlohmann::json notes_ = nlohmann::json::array();
  std::int64_t frames_ = 0;  ///< taken up so far; fewer are written
  RunOutputs outputs_;       ///< after what its notes go to
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  RecordQueue queue_;
  std::deque<MotionFrame> early_;  ///< frames before the first person, which wait for the outputs to begin
  std::size_t drawn_ = 0;          ///< records of the queue that are drawn already: those of `early_`
  Random fill_seeds_;
  WindowState window_;
  std::optional<TwoWaySmoothing> smoothing_;  ///< since a person was calibrated
  bool person_ended_ = false;                 ///< another one is to be calibrated
  RunStatistics statistics_;
};

}  // namespace telemime
