// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <opencv2/videoio.hpp>
#include <string>

#include "telemime/capture/live.h"

namespace telemime {

/// Connects to a stream through FFmpeg. Connecting and each image time out after `patience` seconds.
cv::VideoCapture connect_to_stream(const std::string& url, double patience);

/// The stream as a device, from a new connection that was not read yet. Images of Motion JPEG are received
/// without decoding, so that their time of arrival is known and other sizes and damage are detected. With
/// other codecs, FFmpeg decodes within grab() and skips damaged images, and OpenCV 4.6 does not detect
/// changes of the size: it keeps the old one.
LiveDevice stream_device(const cv::VideoCapture& connection, double patience,
                         const Clock& clock = monotonic_clock());

/// Calls `grab` until it succeeds, at most 25 times; false if it never does. An image that cannot be decoded
/// fails at once, and the next one may succeed. A failure that took more than a second (of `clock`) means
/// that the sender is silent, so it is not repeated. So does a success that took as long as the time-out of
/// an image (`patience`, s): at its end FFmpeg gives out what its decoder still holds.
bool grab_past_damage(const std::function<bool()>& grab, double patience, const Clock& clock);

}  // namespace telemime
