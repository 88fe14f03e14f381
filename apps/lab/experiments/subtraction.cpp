// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/subtraction.h"

#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/background_segm.hpp>

#include "telemime/core/errors.h"
#include "telemime/image/background_model.h"
#include "telemime/image/light_change.h"

namespace telemime {
namespace {

cv::Mat cleaned(const cv::Mat& mask) {
  const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(3, 3));
  cv::Mat out;
  cv::morphologyEx(mask, out, cv::MORPH_OPEN, square);
  cv::morphologyEx(out, out, cv::MORPH_CLOSE, square);
  return out;
}

Subtractor rgb_difference(std::span<const cv::Mat> pictures) {
  cv::Mat sum = cv::Mat::zeros(pictures.front().size(), CV_32FC3);
  for (const cv::Mat& picture : pictures) {
    cv::accumulate(picture, sum);
  }
  cv::Mat mean;
  sum.convertTo(mean, CV_8UC3, 1.0 / static_cast<double>(pictures.size()));
  return [mean](const cv::Mat& bgr) {
    cv::Mat difference;
    cv::absdiff(bgr, mean, difference);
    cv::Mat alike;
    cv::inRange(difference, cv::Scalar::all(0), cv::Scalar::all(25), alike);
    return cleaned(~alike);
  };
}

Subtractor mixture(std::span<const cv::Mat> pictures) {
  const auto model = cv::createBackgroundSubtractorMOG2(500, 16.0, true);
  cv::Mat ignored;
  for (const cv::Mat& picture : pictures) {
    model->apply(picture, ignored);
  }
  return [model](const cv::Mat& bgr) {
    cv::Mat mask;
    model->apply(bgr, mask, 0.002);
    // 127 marks what MOG2 takes for a shadow.
    return cleaned(mask > 200);
  };
}

Subtractor reference(std::span<const cv::Mat> pictures) {
  return [model = learn_reference_background(pictures)](const cv::Mat& bgr) {
    constexpr double kThreshold = 0.005;
    return cleaned(reference_foreground(model, bgr, kThreshold));
  };
}

Subtractor robust(std::span<const cv::Mat> pictures) {
  const auto believed = std::make_shared<cv::Mat>();  // what the last picture showed of the background
  return [model = learn_background_model(pictures), believed](const cv::Mat& bgr) {
    // -2 ln density of a colour that may be anything: a box of 2 x 2.5 x 3 on the scale of LogColour, and the
    // prior of a person.
    constexpr float kAnything = 3.0F;
    LogColour colour = log_colour(bgr);
    compensate(model, estimate_light(model, colour, *believed), colour);
    cv::Mat mask = cleaned(background_energy(model, colour, ShadowRange{}).energy > kAnything);
    cv::Mat grown;
    cv::dilate(mask, grown, cv::getStructuringElement(cv::MORPH_RECT, cv::Size(7, 7)));
    cv::bitwise_not(grown, *believed);
    return mask;
  };
}

}  // namespace

Subtractor make_subtractor(Subtraction method, std::span<const cv::Mat> pictures) {
  if (pictures.empty()) {
    throw Error(ErrorKind::usage, "a background needs at least one picture without a person");
  }
  switch (method) {
    case Subtraction::rgb_difference:
      return rgb_difference(pictures);
    case Subtraction::mixture:
      return mixture(pictures);
    case Subtraction::reference:
      return reference(pictures);
    case Subtraction::robust:
      return robust(pictures);
  }
  throw Error(ErrorKind::usage, "unknown background subtraction");
}

}  // namespace telemime
