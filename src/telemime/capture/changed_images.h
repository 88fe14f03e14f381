// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core.hpp>

#include "telemime/capture/source.h"

namespace telemime {

/// The source with `change` of each image (CV_8UC3) in place of it; everything else is passed on. The image
/// keeps its size. `change` is called from the thread that calls next().
std::unique_ptr<Source> with_changed_images(std::unique_ptr<Source> source,
                                            std::function<cv::Mat(const cv::Mat&)> change);

}  // namespace telemime
