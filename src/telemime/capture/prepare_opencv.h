// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// Keeps OpenCV and FFmpeg from writing to standard error: Error and Source::complaint report problems
/// instead. Also keeps OpenCV from loading OpenCL drivers, which it does not need here and which take 60 MB
/// and a part of a second with Debian's pocl; the back end `opencl` is not affected. Changes the whole
/// process (OpenCV's log level, and OPENCV_FFMPEG_LOGLEVEL and OPENCV_OPENCL_RUNTIME unless the user has set
/// them), so the library never calls it. Programs call it first in main(), before other threads start and
/// before OpenCV is used.
void prepare_opencv();

}  // namespace telemime
