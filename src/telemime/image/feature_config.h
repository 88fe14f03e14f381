// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

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

/// How well the assumptions of the method held in the last frame.
struct ImageStatus {
  bool person = false;            ///< a person is in the image
  double silhouette_share = 0.0;  ///< of the image
  double known_background = 0.0;  ///< share of the image whose background is known
  double camera_motion = 0.0;     ///< pixels per check at 160 columns, averaged
  double light_change = 0.0;      ///< ln of the current luminance over the learned one, mean over the image
  double brightness = 0.0;        ///< mean grey level
  double skin_share = 0.0;        ///< pixels of arms over those of arms and clothes, averaged over time
  std::vector<std::string> warnings;  ///< messages with a remedy; empty if all assumptions hold
};

/// The warnings for these values, as messages for the user.
std::vector<std::string> warnings_of(const ImageStatus& status, const PersonColours& colours);

}  // namespace telemime
