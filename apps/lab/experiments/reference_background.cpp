// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/reference_background.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/core/errors.h"
#include "telemime/image/deriche.h"

namespace telemime {
namespace {

constexpr double kAlpha = 1.0;
/// Below this length (grey levels per pixel) the noise decides the direction.
constexpr float kWeakGradient = 3.0F;
/// Variance added to Cr and Cb (grey levels squared) and to the direction (rad^2).
constexpr float kChromaRidge = 4.0F;
constexpr float kDirectionRidge = 0.02F;

struct Features {
  cv::Mat chroma;  // CV_8UC3: Y, Cr, Cb
  Gradient gradient;
};

Features features_of(const cv::Mat& bgr) {
  Features f;
  cv::cvtColor(bgr, f.chroma, cv::COLOR_BGR2YCrCb);
  cv::Mat grey;
  cv::extractChannel(f.chroma, grey, 0);
  f.gradient = deriche_gradient(grey, kAlpha);
  return f;
}

/// Squared Mahalanobis distances of one image from the model. The cosine is -2 where the direction is
/// unknown.
struct Distances {
  cv::Mat chroma2;
  cv::Mat cosine;
};

Distances distances(const ReferenceBackground& model, const cv::Mat& bgr) {
  const Features f = features_of(bgr);
  Distances out{cv::Mat(bgr.size(), CV_32FC1), cv::Mat(bgr.size(), CV_32FC1)};
  for (int r = 0; r < bgr.rows; ++r) {
    const auto* c = f.chroma.ptr<cv::Vec3b>(r);
    const auto* dx = f.gradient.dx.ptr<float>(r);
    const auto* dy = f.gradient.dy.ptr<float>(r);
    const auto* mean = model.chroma_mean.ptr<cv::Vec2f>(r);
    const auto* inverse = model.chroma_inverse.ptr<cv::Vec3f>(r);
    const auto* direction = model.direction.ptr<cv::Vec2f>(r);
    const auto* strength = model.strength.ptr<float>(r);
    auto* chroma2 = out.chroma2.ptr<float>(r);
    auto* cosine = out.cosine.ptr<float>(r);
    for (int i = 0; i < bgr.cols; ++i) {
      const float cr = static_cast<float>(c[i][1]) - mean[i][0];
      const float cb = static_cast<float>(c[i][2]) - mean[i][1];
      chroma2[i] = inverse[i][0] * cr * cr + 2 * inverse[i][1] * cr * cb + inverse[i][2] * cb * cb;
      const float length = std::sqrt(dx[i] * dx[i] + dy[i] * dy[i]);
      const bool both = length > kWeakGradient && strength[i] > kWeakGradient;
      // -2 is not a cosine: the direction is unknown.
      cosine[i] = both ? (dx[i] * direction[i][0] + dy[i] * direction[i][1]) / length : -2.0F;
    }
  }
  return out;
}

/// z with P(|N(0, 1)| > z) = p, by bisection; once per picture.
double normal_quantile(double p) {
  double low = 0;
  double high = 10;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (std::erfc(middle / std::sqrt(2.0)) > p ? low : high) = middle;
  }
  return low;
}

}  // namespace

ReferenceBackground learn_reference_background(std::span<const cv::Mat> pictures) {
  if (pictures.empty()) {
    throw Error(ErrorKind::usage, "a background needs at least one picture without a person");
  }
  const cv::Size size = pictures.front().size();
  cv::Mat sum = cv::Mat::zeros(size, CV_32FC2);
  cv::Mat products = cv::Mat::zeros(size, CV_32FC3);
  cv::Mat resultant = cv::Mat::zeros(size, CV_32FC2);
  cv::Mat length_sum = cv::Mat::zeros(size, CV_32FC1);
  for (const cv::Mat& picture : pictures) {
    if (picture.size() != size) {
      throw Error(ErrorKind::usage, "the pictures of the background differ in size");
    }
    const Features f = features_of(picture);
    for (int r = 0; r < size.height; ++r) {
      for (int i = 0; i < size.width; ++i) {
        const auto& c = f.chroma.at<cv::Vec3b>(r, i);
        // About 128, so that the sums of squares keep their digits.
        const float cr = static_cast<float>(c[1]) - 128.0F;
        const float cb = static_cast<float>(c[2]) - 128.0F;
        sum.at<cv::Vec2f>(r, i) += cv::Vec2f(cr, cb);
        products.at<cv::Vec3f>(r, i) += cv::Vec3f(cr * cr, cr * cb, cb * cb);
        const float dx = f.gradient.dx.at<float>(r, i);
        const float dy = f.gradient.dy.at<float>(r, i);
        resultant.at<cv::Vec2f>(r, i) += cv::Vec2f(dx, dy);
        length_sum.at<float>(r, i) += std::sqrt(dx * dx + dy * dy);
      }
    }
  }
  const auto n = static_cast<float>(pictures.size());
  const float degrees_of_freedom = std::max(1.0F, n - 1);
  ReferenceBackground model;
  model.chroma_mean.create(size, CV_32FC2);
  model.chroma_inverse.create(size, CV_32FC3);
  model.direction.create(size, CV_32FC2);
  model.direction_variance.create(size, CV_32FC1);
  model.strength = length_sum / n;
  for (int r = 0; r < size.height; ++r) {
    for (int i = 0; i < size.width; ++i) {
      const cv::Vec2f mean = sum.at<cv::Vec2f>(r, i) / n;
      const cv::Vec3f square = products.at<cv::Vec3f>(r, i);
      const float xx = (square[0] - n * mean[0] * mean[0]) / degrees_of_freedom + kChromaRidge;
      const float xy = (square[1] - n * mean[0] * mean[1]) / degrees_of_freedom;
      const float yy = (square[2] - n * mean[1] * mean[1]) / degrees_of_freedom + kChromaRidge;
      const float determinant = std::max(xx * yy - xy * xy, kChromaRidge);
      model.chroma_mean.at<cv::Vec2f>(r, i) = mean + cv::Vec2f(128.0F, 128.0F);
      model.chroma_inverse.at<cv::Vec3f>(r, i) = cv::Vec3f(yy, -xy, xx) / determinant;
      const cv::Vec2f total = resultant.at<cv::Vec2f>(r, i);
      const float length = std::sqrt(total.dot(total));
      // Length of the mean of the unit vectors, weighed by their gradients: 1 when all agree, 0 when none do.
      const float agreement = std::clamp(length / std::max(length_sum.at<float>(r, i), 1e-6F), 1e-3F, 1.0F);
      model.direction.at<cv::Vec2f>(r, i) = length > 0 ? total / length : cv::Vec2f(1, 0);
      model.direction_variance.at<float>(r, i) = -2 * std::log(agreement) + kDirectionRidge;
    }
  }
  return model;
}

cv::Mat reference_probability(const ReferenceBackground& model, const cv::Mat& bgr) {
  const Distances d = distances(model, bgr);
  cv::Mat probability(bgr.size(), CV_32FC1);
  for (int r = 0; r < bgr.rows; ++r) {
    for (int i = 0; i < bgr.cols; ++i) {
      const float by_chroma = std::exp(-0.5F * d.chroma2.at<float>(r, i));
      const float cosine = d.cosine.at<float>(r, i);
      float by_direction = 0;
      if (cosine >= -1.5F) {
        const float angle = std::acos(std::clamp(cosine, -1.0F, 1.0F));
        by_direction = std::erfc(angle / std::sqrt(2 * model.direction_variance.at<float>(r, i)));
      }
      probability.at<float>(r, i) = std::max(by_chroma, by_direction);
    }
  }
  return probability;
}

cv::Mat reference_foreground(const ReferenceBackground& model, const cv::Mat& bgr, double threshold) {
  if (!(threshold > 0 && threshold < 1)) {
    throw Error(ErrorKind::usage, "the threshold of a probability must lie between 0 and 1");
  }
  const Distances d = distances(model, bgr);
  const auto chroma_limit = static_cast<float>(-2 * std::log(threshold));
  const auto z = static_cast<float>(normal_quantile(threshold));
  constexpr float kPi = 3.14159265F;
  cv::Mat out(bgr.size(), CV_8UC1);
  for (int r = 0; r < bgr.rows; ++r) {
    const auto* chroma2 = d.chroma2.ptr<float>(r);
    const auto* cosine = d.cosine.ptr<float>(r);
    const auto* variance = model.direction_variance.ptr<float>(r);
    auto* o = out.ptr<unsigned char>(r);
    for (int i = 0; i < bgr.cols; ++i) {
      bool background = chroma2[i] <= chroma_limit;
      if (!background && cosine[i] >= -1.5F) {
        const float widest = std::min(z * std::sqrt(variance[i]), kPi);
        background = cosine[i] >= std::cos(widest);
      }
      o[i] = background ? 0 : 255;
    }
  }
  return out;
}

}  // namespace telemime
