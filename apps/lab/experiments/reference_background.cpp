// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "lab/experiments/subtraction.h"
#include "telemime/core/errors.h"
#include "telemime/image/deriche.h"

namespace telemime {
namespace {

/// Below this length (grey levels per pixel) the noise decides the direction.
constexpr double kWeakGradient = 3.0;
/// Variance added to Cr and Cb (grey levels squared) and to the direction (rad^2).
constexpr double kChromaRidge = 4.0;
constexpr double kDirectionRidge = 0.02;
/// Stands for the cosine of an unknown direction.
constexpr float kUnknown = -2.0F;

struct Features {
  cv::Mat cr, cb;  // CV_32FC1, less 128, so that sums of squares keep their digits
  Gradient gradient;
  cv::Mat length;  // of the gradient
};

Features features_of(const cv::Mat& bgr) {
  cv::Mat chroma;
  cv::cvtColor(bgr, chroma, cv::COLOR_BGR2YCrCb);
  std::array<cv::Mat, 3> planes;
  cv::split(chroma, planes.data());
  constexpr double kAlpha = 1.0;
  Features f;
  f.gradient = deriche_gradient(planes[0], kAlpha);
  planes[1].convertTo(f.cr, CV_32F, 1.0, -128.0);
  planes[2].convertTo(f.cb, CV_32F, 1.0, -128.0);
  cv::magnitude(f.gradient.dx, f.gradient.dy, f.length);
  return f;
}

}  // namespace

ReferenceBackground learn_reference_background(std::span<const cv::Mat> pictures) {
  if (pictures.empty()) {
    throw Error(ErrorKind::usage, "a background needs at least one picture without a person");
  }
  const cv::Size size = pictures.front().size();
  std::array<cv::Mat, 8> sums;
  for (cv::Mat& sum : sums) {
    sum = cv::Mat::zeros(size, CV_32F);
  }
  for (const cv::Mat& picture : pictures) {
    if (picture.size() != size) {
      throw Error(ErrorKind::usage, "the pictures of the background differ in size");
    }
    const Features f = features_of(picture);
    const std::array<cv::Mat, 8> terms = {f.cr,           f.cb,          f.cr.mul(f.cr), f.cr.mul(f.cb),
                                          f.cb.mul(f.cb), f.gradient.dx, f.gradient.dy,  f.length};
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i] += terms[i];
    }
  }
  const auto& [cr, cb, rr, rb, bb, dx, dy, length] = sums;
  const auto n = static_cast<double>(pictures.size());
  const double degrees_of_freedom = std::max(1.0, n - 1.0);
  ReferenceBackground model;
  model.cr = cr / n;
  model.cb = cb / n;
  model.strength = length / n;
  const cv::Mat var_r = (rr - n * model.cr.mul(model.cr)) / degrees_of_freedom + kChromaRidge;
  const cv::Mat var_rb = (rb - n * model.cr.mul(model.cb)) / degrees_of_freedom;
  const cv::Mat var_b = (bb - n * model.cb.mul(model.cb)) / degrees_of_freedom + kChromaRidge;
  const cv::Mat determinant = cv::max(var_r.mul(var_b) - var_rb.mul(var_rb), kChromaRidge);
  model.inverse_rr = var_b / determinant;
  model.inverse_rb = -var_rb / determinant;
  model.inverse_bb = var_r / determinant;
  cv::Mat resultant;
  cv::magnitude(dx, dy, resultant);
  resultant = cv::max(resultant, 1e-6);
  model.direction_x = dx / resultant;
  model.direction_y = dy / resultant;
  // Length of the mean of the unit vectors, weighed by their gradients: 1 when all agree, 0 when none do.
  const cv::Mat agreement = cv::min(cv::max(resultant / cv::max(length, 1e-6), 1e-3), 1.0);
  cv::log(agreement, model.direction_variance);
  model.direction_variance = -2.0 * model.direction_variance + kDirectionRidge;
  return model;
}

cv::Mat reference_foreground(const ReferenceBackground& model, const cv::Mat& bgr, double threshold) {
  if (!(threshold > 0 && threshold < 1)) {
    throw Error(ErrorKind::usage, "the threshold of a probability must lie between 0 and 1");
  }
  const Features f = features_of(bgr);
  // Squared Mahalanobis distance of the chroma.
  const cv::Mat cr = f.cr - model.cr;
  const cv::Mat cb = f.cb - model.cb;
  const cv::Mat chroma2 = model.inverse_rr.mul(cr).mul(cr) + 2.0 * model.inverse_rb.mul(cr).mul(cb) +
                          model.inverse_bb.mul(cb).mul(cb);
  // Cosine of the angle between the directions.
  cv::Mat cosines = (f.gradient.dx.mul(model.direction_x) + f.gradient.dy.mul(model.direction_y)) / f.length;
  cosines.setTo(kUnknown, (f.length <= kWeakGradient) | (model.strength <= kWeakGradient));
  // Both are compared with their limits: no logarithm or exponential per pixel.
  // z with P(|N(0, 1)| > z) = threshold.
  const auto z = static_cast<float>(std::numbers::sqrt2 * boost::math::erfc_inv(threshold));
  cv::Mat out = chroma2 > -2.0 * std::log(threshold);
  for (int r = 0; r < bgr.rows; ++r) {
    const auto* cosine = cosines.ptr<float>(r);
    const auto* variance = model.direction_variance.ptr<float>(r);
    auto* o = out.ptr<unsigned char>(r);
    for (int i = 0; i < bgr.cols; ++i) {
      if (o[i] != 0 && cosine[i] != kUnknown) {
        const float widest = std::min(z * std::sqrt(variance[i]), std::numbers::pi_v<float>);
        o[i] = cosine[i] >= std::cos(widest) ? 0 : 255;
      }
    }
  }
  return out;
}

}  // namespace telemime
