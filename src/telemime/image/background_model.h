// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <span>

#include "telemime/image/log_colour.h"

namespace telemime {

/// What the empty scene looks like at every pixel, on the scale of LogColour. Planes (h x w).
struct BackgroundModel {
  LogColour mean;
  cv::Mat chroma_variance;     ///< CV_32FC1, of u and v together, never below the floor
  cv::Mat luminance_variance;  ///< CV_32FC1, of l
  cv::Mat valid;               ///< CV_8UC1, 255 where the background was seen
  cv::Mat seen;                ///< CV_8UC1, frames in a row in which a pixel not yet valid looked like scene
  bool empty() const { return valid.empty(); }
};

/// Mean and variance of each pixel over pictures (CV_8UC3, one size) without a person; all pixels valid.
/// Thesis 3.4.1 with colours that a shadow moves along one axis. Throws Error(usage) when there is no
/// picture or sizes differ.
BackgroundModel learn_background_model(std::span<const cv::Mat> pictures);

/// Energies (-2 ln density over [u, v, l], without 3 ln 2 pi) of every pixel under the background.
struct BackgroundEnergy {
  cv::Mat energy;         ///< CV_32FC1: the better of unshaded and shaded
  cv::Mat shaded;         ///< CV_8UC1, 255 where the shadow explains the pixel better
  bool doubtful = false;  ///< the model may hold parts of the person: holes in him are not to be believed
};

/// How a cast shadow may look.
struct ShadowRange {
  float darkest = 0.55F;    ///< smallest ratio of luminance still taken for a shadow, in (0, 1)
  float typical = 0.15F;    ///< mean darkening, on the scale of logarithms
  float chroma = 0.035F;    ///< deviation of u and v in a shadow (bounced light is coloured)
  float prior_cost = 1.0F;  ///< -2 ln of the share of shaded pixels
};

/// `picture` must already have its gain undone (estimate_gain). Pixels that are not valid take theirs from
/// `unknown` (CV_32FC1; may be empty when all are valid).
BackgroundEnergy background_energy(const BackgroundModel& model, const LogColour& picture,
                                   const ShadowRange& shadow, const cv::Mat& unknown);

/// What a lamp, a shadow as wide as the room, or the camera's own gain and white balance added to the
/// picture: picture - model, one median per cell of a coarse grid over pixels that are valid and where
/// `believed` (CV_8UC1; empty: everywhere) is not 0, smoothed over the grid and stretched to the picture.
/// Cells without enough such pixels take from their neighbours, a picture without any gets zeros. Three
/// planes like LogColour.
LogColour estimate_gain(const BackgroundModel& model, const LogColour& picture, const cv::Mat& believed);

/// Moves the model towards the picture by `rate` in [0, 1] where `where` (CV_8UC1) is not 0. Pixels that were
/// not valid become so after 12 frames in a row there with a steady colour.
void adapt_background(BackgroundModel& model, const LogColour& picture, const cv::Mat& where, float rate);

}  // namespace telemime
