// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "telemime/core/camera.h"
#include "telemime/core/settings.h"
#include "telemime/image/background_model.h"
#include "telemime/image/head_tracker.h"
#include "telemime/image/person_colours.h"
#include "telemime/image/segmentation.h"

namespace telemime {

/// Edges of the working image. The table of settings (settings_of) gives the meaning, unit and range of each.
struct EdgeConfig {
  double alpha = 1.2;
  double low = 3.0;
  double high = 8.0;
  double distance_cap = 10.0;
};

/// Settings of the image module; the table (settings_of) gives the meaning, unit and range of each.
struct ImageConfig {
  int width = 160;
  int height = 120;
  std::string models;
  bool landmarks = true;
  std::string cascades;
  int face_width = 320;
  HeadTrackerConfig head;
  double head_shape_rate = 0.2;
  ShadowRange shadow;
  SegmentationConfig segmentation;
  EdgeConfig edges;
  float background_rate = 0.01F;
  int motion_every = 10;
  float mask_trust = 8.0F;
};

SettingTable settings_of(ImageConfig& config);

/// The configuration for images of `camera`: its focal length, and a working image of about the configured
/// number of pixels with square pixels (within 1 %). Heads are recognised by their shape, which an image of
/// 16:9 squeezed into 4:3 would distort.
ImageConfig fitted_to(ImageConfig config, const Camera& camera);

}  // namespace telemime
