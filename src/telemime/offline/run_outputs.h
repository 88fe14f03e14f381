// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "telemime/outputs/file_output.h"
#include "telemime/tracker/track_request.h"

namespace telemime {

/// Makes the folder of the results and sees to it that they can be written there. Throws Error(usage) for a
/// format or an option that there is not, Error(output).
void prepare_outputs(const TrackRequest& request);

/// Throws Error(output) where a file of that name could not be written later; writes nothing.
void prepare_file(const std::filesystem::path& file);

/// The files of one run: the encoders' and the overlay video.
class RunOutputs {
 public:
  /// Throws as prepare_outputs does.
  RunOutputs(const TrackRequest& request, double fps);

  /// Opens the encoders' files: the head of each holds the person's shape, so this waits until it is known.
  /// Throws Error(output).
  void begin(const StreamHeader& header);
  bool begun() const { return !outputs_.empty(); }

  void write(const MotionFrame& frame);
  /// Throws Error(output) when the video cannot be made.
  void write_overlay(const cv::Mat& picture);
  /// Finishes all files and writes report.json and overlay.png. Throws Error(output).
  void close(const nlohmann::json& report);

  std::vector<std::string> files() const;

 private:
  std::filesystem::path folder_;
  std::vector<std::string> formats_;
  OutputOptions options_;
  double fps_;
  std::vector<std::unique_ptr<FileOutput>> outputs_;
  cv::VideoWriter video_;
  cv::Mat best_overlay_;
  std::int64_t overlays_ = 0;
};

}  // namespace telemime
