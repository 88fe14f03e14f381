// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/subtraction.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/background_segm.hpp>
#include <utility>

#include "lab/experiments/reference_background.h"
#include "telemime/core/errors.h"
#include "telemime/image/background_model.h"

namespace telemime {
namespace {

cv::Mat cleaned(const cv::Mat& mask) {
  const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(3, 3));
  cv::Mat out;
  cv::morphologyEx(mask, out, cv::MORPH_OPEN, square);
  cv::morphologyEx(out, out, cv::MORPH_CLOSE, square);
  return out;
}

class RgbDifference : public Subtractor {
 public:
  explicit RgbDifference(std::span<const cv::Mat> pictures) {
    cv::Mat sum = cv::Mat::zeros(pictures.front().size(), CV_32FC3);
    for (const cv::Mat& picture : pictures) {
      cv::accumulate(picture, sum);
    }
    sum.convertTo(mean_, CV_8UC3, 1.0 / static_cast<double>(pictures.size()));
  }
  cv::Mat foreground(const cv::Mat& bgr) override {
    constexpr int kThreshold = 25;
    cv::Mat difference;
    cv::absdiff(bgr, mean_, difference);
    cv::Mat mask(bgr.size(), CV_8UC1);
    for (int r = 0; r < bgr.rows; ++r) {
      const auto* d = difference.ptr<unsigned char>(r);
      auto* m = mask.ptr<unsigned char>(r);
      for (int c = 0; c < bgr.cols; ++c, d += 3) {
        m[c] = d[0] > kThreshold || d[1] > kThreshold || d[2] > kThreshold ? 255 : 0;
      }
    }
    return cleaned(mask);
  }

 private:
  cv::Mat mean_;
};

class Mixture : public Subtractor {
 public:
  explicit Mixture(std::span<const cv::Mat> pictures)
      : model_(cv::createBackgroundSubtractorMOG2(500, 16.0, true)) {
    cv::Mat ignored;
    for (const cv::Mat& picture : pictures) {
      model_->apply(picture, ignored);
    }
  }
  cv::Mat foreground(const cv::Mat& bgr) override {
    cv::Mat mask;
    model_->apply(bgr, mask, 0.002);
    // 127 marks what MOG2 takes for a shadow.
    return cleaned(mask > 200);
  }

 private:
  cv::Ptr<cv::BackgroundSubtractorMOG2> model_;
};

class Reference : public Subtractor {
 public:
  explicit Reference(std::span<const cv::Mat> pictures) : model_(learn_reference_background(pictures)) {}
  cv::Mat foreground(const cv::Mat& bgr) override {
    constexpr double kThreshold = 0.005;
    return cleaned(reference_foreground(model_, bgr, kThreshold));
  }

 private:
  ReferenceBackground model_;
};

class Robust : public Subtractor {
 public:
  explicit Robust(std::span<const cv::Mat> pictures) : model_(learn_background_model(pictures)) {}
  cv::Mat foreground(const cv::Mat& bgr) override {
    // -2 ln density of a colour that may be anything: a box of 2 x 2.5 x 3 on the scale of LogColour, and the
    // prior of a person.
    constexpr float kAnything = 3.0F;
    LogColour colour = log_colour(bgr);
    subtract(colour, estimate_gain(model_, colour, believed_));
    cv::Mat mask = cleaned(background_energy(model_, colour, ShadowRange{}, {}).energy > kAnything);
    cv::Mat grown;
    cv::dilate(mask, grown, cv::getStructuringElement(cv::MORPH_RECT, cv::Size(7, 7)));
    cv::bitwise_not(grown, believed_);
    return mask;
  }

 private:
  BackgroundModel model_;
  cv::Mat believed_;
};

}  // namespace

std::unique_ptr<Subtractor> make_subtractor(Subtraction method, std::span<const cv::Mat> pictures) {
  if (pictures.empty()) {
    throw Error(ErrorKind::usage, "a background needs at least one picture without a person");
  }
  switch (method) {
    case Subtraction::rgb_difference:
      return std::make_unique<RgbDifference>(pictures);
    case Subtraction::mixture:
      return std::make_unique<Mixture>(pictures);
    case Subtraction::reference:
      return std::make_unique<Reference>(pictures);
    case Subtraction::robust:
      return std::make_unique<Robust>(pictures);
  }
  throw Error(ErrorKind::usage, "unknown background subtraction");
}

}  // namespace telemime
