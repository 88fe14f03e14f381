// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/prepare_opencv.h"

#include <cstdlib>
#include <opencv2/core/utils/logger.hpp>

namespace telemime {

void prepare_opencv() {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  const int keep_what_the_user_set = 0;
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", keep_what_the_user_set);  // -8 is AV_LOG_QUIET
  ::setenv("OPENCV_OPENCL_RUNTIME", "disabled", keep_what_the_user_set);
}

}  // namespace telemime
