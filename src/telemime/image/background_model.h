// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <span>

#include "telemime/image/log_colour.h"

namespace telemime {

/// Model of the scene without a person: a Gaussian for each pixel over the colours of LogColour. All planes
/// are h x w.
struct BackgroundModel {
  LogColour mean;
  cv::Mat chroma_variance;     ///< CV_32FC1, of u and v together, at least the noise floor
  cv::Mat luminance_variance;  ///< CV_32FC1, of l
  cv::Mat valid;               ///< CV_8UC1, 255 where the background is known
  cv::Mat seen;                ///< CV_8UC1, consecutive frames in which an invalid pixel was background
  bool empty() const { return valid.empty(); }
};

/// How much quantisation, compression, flicker and the noise of the camera make a background of luminance `l`
/// vary.
struct BackgroundNoise {
  float chroma = 0.0F;     ///< variance
  float luminance = 0.0F;  ///< variance
};
BackgroundNoise background_noise(float l);

/// Mean and variance of each pixel over images without a person (CV_8UC3, same size), in the light of the
/// first. All pixels are valid. Thesis 3.4.1, with logarithmic colours. Throws Error(usage) if `images` is
/// empty or sizes differ.
BackgroundModel learn_background_model(std::span<const cv::Mat> images);

/// Energy of each pixel under the background model: -2 ln of the density over [u, v, l], without the constant
/// 3 ln 2 pi.
struct BackgroundEnergy {
  cv::Mat energy;         ///< CV_32FC1, the lower of the energies without and with a shadow
  cv::Mat shaded;         ///< CV_8UC1, 255 where the energy with a shadow is lower
  bool doubtful = false;  ///< the model may contain parts of the person, so holes in them are unreliable
};

/// Appearance of a cast shadow. The table of settings (settings_of(ImageConfig&)) gives the meaning of each.
struct ShadowRange {
  float darkest = 0.55F;
  float typical = 0.15F;
  float chroma = 0.035F;
  float prior_cost = 1.0F;
};

/// Energies of all pixels; those of invalid pixels mean nothing. Changes of light must have been compensated
/// in `image` (compensate in light_change.h).
BackgroundEnergy background_energy(const BackgroundModel& model, const LogColour& image,
                                   const ShadowRange& shadow);

/// Gives invalid pixels their energy from `unknown` (CV_32FC1), without a shadow.
void set_unknown(const BackgroundModel& model, const cv::Mat& unknown, BackgroundEnergy& energy);

/// Moves the mean of the model towards the image by `rate` in [0, 1] where `where` (CV_8UC1) is not 0.
/// Invalid pixels become valid, with the noise of their colour as variance, after `steady` consecutive frames
/// (1 to 255) there with a steady colour.
void adapt_background(BackgroundModel& model, const LogColour& image, const cv::Mat& where, float rate,
                      int steady = 12);

}  // namespace telemime
