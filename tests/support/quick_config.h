// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracker/config.h"

/// Settings with which a tracker has little work to do on the frames of synthetic_clip.h, and takes the first
/// for good.
namespace telemime::support {

inline Config quick_config() {
  Config config;
  config.image.width = 160;
  config.image.height = 120;
  config.calibration.pose_iterations = 300;
  config.calibration.arms.samples = 150;
  config.calibration.shape.iterations = 120;
  config.calibration.rounds = 1;
  config.tracking.calibration_patience = 0;
  config.tracking.lost_region = 0.6;
  return config;
}

}  // namespace telemime::support
