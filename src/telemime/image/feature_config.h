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
  int face_width = 320;            ///< the face detector looks at pictures of at most this width
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

/// The configuration for pictures of this camera: its focal length, and a working image of about as many
/// pixels whose pixels are square. People are known
/// by their shape, and a picture of 16:9 that is squeezed into 4:3 makes every head too high. As it is where
/// they are square within 1 %.
ImageConfig fitted_to(ImageConfig config, const Camera& camera);

/// What calibration learned; a value that can be saved (calibration_file.h).
struct ImageCalibration {
  BackgroundModel background;
  ColourMixture surroundings;  ///< only when the scene was learned around a person
  bool doubtful = false;       ///< ... and so may hold parts of that person
  PersonColours colours;
};

/// How well the assumptions hold, as of the last frame.
struct ImageStatus {
  bool person = false;                ///< somebody is in the picture
  double silhouette_share = 0.0;      ///< of the picture
  double known_background = 0.0;      ///< share of the picture whose background was seen
  double camera_motion = 0.0;         ///< pixels per look at 160 columns, averaged
  double light_change = 0.0;          ///< ln of the present light over the learned one, mean over the scene
  double brightness = 0.0;            ///< mean grey level
  double skin_share = 0.0;            ///< arms over arms and clothes, averaged over frames with a person
  std::vector<std::string> warnings;  ///< sentences with what to do; empty when all is well
};

/// The sentences for these numbers.
std::vector<std::string> warnings_of(const ImageStatus& status, const PersonColours& colours);

}  // namespace telemime
