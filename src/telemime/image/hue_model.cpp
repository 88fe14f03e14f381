// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/hue_model.h"

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;

/// [hue in radians, saturation in 0 to 1, value] as CV_32FC3.
cv::Mat hsv_of(const cv::Mat& bgr) {
  cv::Mat real;
  bgr.convertTo(real, CV_32FC3, 1.0 / 255.0);
  cv::cvtColor(real, real, cv::COLOR_BGR2HSV);
  cv::multiply(real, cv::Scalar(kTwoPi / 360.0F, 1, 1), real);
  return real;
}

/// The difference of two angles in [-pi, pi].
float unwrapped(float angle) {
  return std::remainder(angle, kTwoPi);
}

}  // namespace

HueModel learn_hue(const cv::Mat& bgr, const cv::Mat& mask) {
  const cv::Mat hsv = hsv_of(bgr);
  double x = 0;
  double y = 0;
  double saturation = 0;
  int count = 0;
  const auto for_each = [&](const auto& use) {
    for (int r = 0; r < hsv.rows; ++r) {
      for (int c = 0; c < hsv.cols; ++c) {
        if (mask.at<unsigned char>(r, c) != 0) {
          use(hsv.at<cv::Vec3f>(r, c));
        }
      }
    }
  };
  for_each([&](const cv::Vec3f& p) {
    // Weighed by saturation: the hue of a grey pixel is noise.
    x += p[1] * std::cos(p[0]);
    y += p[1] * std::sin(p[0]);
    saturation += p[1];
    ++count;
  });
  if (count < 8) {
    throw Error(ErrorKind::usage,
                "a colour needs at least 8 sample pixels, there are " + std::to_string(count));
  }
  HueModel model;
  model.hue = static_cast<float>(std::atan2(y, x));
  model.hue += model.hue < 0 ? kTwoPi : 0.0F;
  model.saturation = static_cast<float>(saturation / count);
  // Below 10 % of saturation, or when the hues of the sample point everywhere, there is no hue to learn.
  model.coloured = model.saturation > 0.1F && std::hypot(x, y) > 0.5 * saturation;
  cv::Matx22f covariance = cv::Matx22f::zeros();
  for_each([&](const cv::Vec3f& p) {
    const float h = unwrapped(p[0] - model.hue);
    const float s = p[1] - model.saturation;
    covariance += cv::Matx22f(h * h, h * s, h * s, s * s);
  });
  covariance *= 1.0F / static_cast<float>(count);
  // 8-bit steps: two degrees of hue, one percent of saturation.
  covariance(0, 0) += 0.035F * 0.035F;
  covariance(1, 1) += 0.01F * 0.01F;
  model.inverse = covariance.inv();
  return model;
}

cv::Mat hue_distance2(const HueModel& model, const cv::Mat& bgr) {
  const cv::Mat hsv = hsv_of(bgr);
  cv::Mat out(bgr.size(), CV_32FC1);
  for (int r = 0; r < hsv.rows; ++r) {
    for (int c = 0; c < hsv.cols; ++c) {
      const auto& p = hsv.at<cv::Vec3f>(r, c);
      const float h = unwrapped(p[0] - model.hue);
      const float s = p[1] - model.saturation;
      out.at<float>(r, c) =
          model.inverse(0, 0) * h * h + 2 * model.inverse(0, 1) * h * s + model.inverse(1, 1) * s * s;
    }
  }
  return out;
}

}  // namespace telemime
