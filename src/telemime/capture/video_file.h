// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "telemime/capture/input_kind.h"
#include "telemime/capture/source.h"

namespace telemime {

/// Opens a video file, whatever its name. All frames that can be decoded are returned; their times are those
/// of the time stamps (TimeBase), their pixels square. complaint() reports a file that ends well before what
/// its header states in frames and in time. Throws Error(input) for a file that is missing, empty,
/// unreadable, text, not a video, or without a frame.
std::unique_ptr<Source> open_video_file(const std::string& path, const InputOptions& options = {});

/// The time stamps (s) of the first frames of an open video, which are read for that.
std::vector<double> first_stamps(cv::VideoCapture video);

/// An open video, such as a finite one at a URL, with what is known of it.
struct OpenVideo {
  cv::VideoCapture video;  ///< shared with the source
  std::string name;        ///< for messages
  InputKind kind = InputKind::video_file;
  std::vector<double> stamps;  ///< first_stamps() of a second capture
};
std::unique_ptr<Source> video_source(const OpenVideo& opened, const InputOptions& options);

/// Width of a pixel of an open video by its height, as it is shown; 1 if it states nothing usable.
double pixel_aspect(const cv::VideoCapture& video);

}  // namespace telemime
