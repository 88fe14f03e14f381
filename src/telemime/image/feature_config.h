// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "telemime/core/camera.h"
#include "telemime/image/background_model.h"
#include "telemime/image/head_tracker.h"
#include "telemime/image/person_colours.h"
#include "telemime/image/segmentation.h"

namespace telemime {

struct EdgeConfig {
  double alpha = 1.2;          ///< of the Deriche filter, at any working size
  double low = 3.0;            ///< grey levels per pixel
  double high = 8.0;           ///< grey levels per pixel
  double distance_cap = 10.0;  ///< pixels at 160 columns; grows with the working width
};

struct ImageConfig {
  int width = 160;                 ///< of the working image, pixels; see fitted_to
  int height = 120;                ///< pixels
  std::filesystem::path cascades;  ///< folder of OpenCV's face cascades; empty: searched
  int face_width = 320;            ///< the face detector looks at images of at most this width
  HeadTrackerConfig head;
  double head_shape_rate = 0.2;  ///< share of each frame in the head's outline, [0, 1]
  ShadowRange shadow;
  SegmentationConfig segmentation;
  EdgeConfig edges;
  float background_rate = 0.01F;  ///< share of each frame that uncovered background takes over, [0, 1]
  int motion_every = 10;          ///< frames between looks at whether the camera moves; 0: never
  /// Throws Error(config) that names the value and its range.
  void validate() const;
};

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
