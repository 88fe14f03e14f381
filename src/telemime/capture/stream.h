// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <opencv2/videoio.hpp>
#include <string>

#include "telemime/capture/live.h"

namespace telemime {

/// Connects to a stream through FFmpeg; waits `patience` s at most, and as long for each picture.
cv::VideoCapture connect_to_stream(const std::string& url, double patience);

/// The stream as a device, from a connection that was made just now and not read from. Of Motion JPEG the
/// pictures are taken undecoded: the time of arrival is known then, and other sizes and damage are seen. With
/// other codecs FFmpeg decodes within grab(), pictures that cannot be decoded are passed over, and OpenCV 4.6
/// does not see that the size changes: it goes on with the old one.
LiveDevice stream_device(const cv::VideoCapture& connection, const Clock& clock = monotonic_clock());

/// Calls `grab` until it succeeds, 25 times at most: false when it never does. A picture that cannot be
/// decoded fails at once, and the next one may be whole. A failure that took more than a second (of `clock`)
/// is a sender that has fallen silent: another try would only wait as long again.
bool grab_past_damage(const std::function<bool()>& grab, const Clock& clock);

}  // namespace telemime
