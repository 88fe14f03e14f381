// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// Keeps OpenCV and FFmpeg from writing to standard error; telemime reports what matters through Error and
/// Source::complaint instead. Also keeps OpenCV from loading OpenCL drivers, of which none of its functions
/// makes use here: with Debian's pocl they take 60 MB and a part of a second. The back end `opencl` is not
/// concerned. Changes the whole process (OpenCV's log level, and OPENCV_FFMPEG_LOGLEVEL and
/// OPENCV_OPENCL_RUNTIME unless the user has set them), so the library never calls it: a program does, first
/// thing in main(), before any other thread starts and before OpenCV is used.
void prepare_opencv();

}  // namespace telemime
