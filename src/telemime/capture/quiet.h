// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// Keeps OpenCV and FFmpeg from writing to standard error; telemime reports what matters through Error and
/// Source::complaint instead. Changes the whole process (OpenCV's log level, and OPENCV_FFMPEG_LOGLEVEL
/// unless the user has set it), so the library never calls it: a program does, first thing in main(), before
/// any other thread starts and before the first video is opened.
void quiet_opencv();

}  // namespace telemime
