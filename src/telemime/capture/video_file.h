// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <opencv2/videoio.hpp>
#include <string>

#include "telemime/capture/input_kind.h"
#include "telemime/capture/source.h"

namespace telemime {

/// Opens a video file. Every frame that can be decoded is handed out; times are those of the file where it
/// has any, else index / fps. A file that ends well before the number of frames in its header draws a
/// complaint. Throws Error(input): no such file, empty, unreadable, text, not a video, no frame in it.
std::unique_ptr<Source> open_video_file(const std::string& path);

/// The same (it shares the capture) for a video that is open already, such as a finite one behind a URL.
/// `name` is for messages.
std::unique_ptr<Source> video_source(const cv::VideoCapture& video, const std::string& name, InputKind kind);

}  // namespace telemime
