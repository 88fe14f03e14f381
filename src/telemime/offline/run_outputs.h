// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "telemime/offline/motion_files.h"
#include "telemime/offline/overlay_video.h"
#include "telemime/offline/resampler.h"
#include "telemime/tracker/track_request.h"

namespace telemime {

/// What a request reads, by the user's names: input, background clip, camera, calibration, limits and the
/// filter's model; empty ones where it names none.
std::array<std::string, 6> names_read(const TrackRequest& request);

/// Makes the folder of the results and sees to it that they can be written there. Throws Error(usage) for a
/// format or an option that there is not, and where a result would replace a file that the request reads;
/// Error(output).
void prepare_outputs(const TrackRequest& request);

/// Throws Error(output) where a file of that name could not be written later, and Error(usage) where it would
/// replace one that the request reads; writes nothing.
void prepare_file(const std::filesystem::path& file, const TrackRequest& request = {});

/// The files of one run: the encoders' and the overlay video. None where the request names no folder.
class RunOutputs {
 public:
  /// Removes the report of an earlier run, whose files this one replaces. Throws as prepare_outputs does.
  /// `fps`: of the input; `note` gets what is wrong with the overlay.
  RunOutputs(const TrackRequest& request, double fps, OverlayVideo::Note note);

  /// Opens the encoders' files: the head of each holds the person's shape, so this waits until it is known.
  /// Throws Error(output).
  void begin(const StreamHeader& header);

  /// The person of the frames that follow; the heads of the files keep the first.
  void set_body(const Body& body);

  /// A frame at its true time, which must increase; files of constant rate get resampled ones.
  void write(const MotionFrame& frame);
  bool has_overlay() const { return video_ && video_->usable(); }
  void write_overlay(const cv::Mat& picture, double time);
  void close_overlay();
  /// Finishes all files and writes report.json. Throws Error(output).
  void close(const nlohmann::json& report);

  std::vector<std::string> files() const;

 private:
  std::filesystem::path folder_;
  std::vector<std::string> formats_;
  OutputOptions options_;
  MotionFiles outputs_;
  std::optional<Resampler> resampler_;
  std::optional<OverlayVideo> video_;
};

}  // namespace telemime
