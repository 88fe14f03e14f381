// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <opencv2/videoio.hpp>
#include <string>

#include "telemime/capture/input_kind.h"
#include "telemime/capture/source.h"

namespace telemime {

/// Opens a video file. All frames that can be decoded are returned; their times are those of the file, or
/// index / fps if it has none. complaint() reports a file that ends well before the number of frames in its
/// header. Throws Error(input) for a file that is missing, empty, unreadable, text, not a video, or without a
/// frame.
std::unique_ptr<Source> open_video_file(const std::string& path);

/// A source for an open video, such as a finite one at a URL; it shares the capture. `name` is for messages.
std::unique_ptr<Source> video_source(const cv::VideoCapture& video, const std::string& name, InputKind kind);

}  // namespace telemime
