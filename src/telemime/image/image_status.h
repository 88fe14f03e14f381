// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "telemime/image/person_colours.h"

namespace telemime {

/// ImageStatus::camera_motion above which the user is warned and no background is learned around a person.
inline constexpr double kCameraIsUnsteady = 0.7;
/// ImageStatus::camera_motion above which the background model is dropped.
inline constexpr double kBackgroundIsVoid = 1.5;

/// How well the assumptions of the method held in the last frame.
struct ImageStatus {
  bool person = false;            ///< a person is in the image
  double silhouette_share = 0.0;  ///< of the image
  double known_background = 0.0;  ///< share of the image whose background is known
  double camera_motion = 0.0;     ///< per check, pixels of 160 (core/camera.h, reference_width), averaged
  double light_change = 0.0;      ///< ln of the current luminance over the learned one, mean over the image
  double brightness = 0.0;        ///< mean grey level
  double white_share = 0.0;       ///< share of the head's pixels that are white, averaged over time
  double detail = 255.0;          ///< 99th percentile of the gradient (detail_of)
  double coloured_share = 1.0;    ///< pixels with a colour of their own, averaged over time
  int people = 0;                 ///< in the picture, as far as networks see
  bool other_person = false;      ///< the finder went over to somebody else in this frame
  double skin_share = 0.0;        ///< pixels of arms over those of arms and clothes, averaged over time
  std::vector<std::string> warnings;  ///< messages with a remedy; empty if all assumptions hold
};

/// Whether the picture shows anything at all: it is neither black nor without detail.
bool shows_something(const ImageStatus& status);
/// Whether the picture has colours. Without them, skin and clothes cannot be told apart.
bool has_colour(const ImageStatus& status);

/// Whether this share of coloured pixels is that of a picture with colours.
bool is_coloured(double share);
/// 99th percentile of the gradient of an image (CV_8UC1) resized to a reference width of 160, grey levels a
/// pixel.
double detail_of(const cv::Mat& grey);
/// Share of the pixels of an image (CV_8UC3), in a grid, whose chroma differs from that of the whole image: 0
/// for an infrared or black-and-white image, tinted or not.
double coloured_share_of(const cv::Mat& bgr);

/// Share of the pixels in the mask (CV_8UC1) of this picture (CV_8UC3) that are as white as the camera can
/// show. 0 for an empty mask.
double white_share_of(const cv::Mat& bgr, const cv::Mat& mask);

/// The warnings for these values, as messages for the user.
std::vector<std::string> warnings_of(const ImageStatus& status, const PersonColours& colours);

}  // namespace telemime
