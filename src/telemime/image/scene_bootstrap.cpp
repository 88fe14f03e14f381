// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/scene_bootstrap.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/image/light_change.h"
#include "telemime/image/person_shape.h"

namespace telemime {
namespace {

/// Largest difference between two observations of the same background colour by a static camera.
constexpr float kSameChroma = 0.09F;
constexpr float kSameLuminance = 0.12F;

/// Share of pixels that differ by more than noise after compensation of a global change of light.
double changed_share(const LogColour& a, const LogColour& b) {
  cv::Mat dl = b.l - a.l;
  cv::blur(dl, dl, cv::Size(3, 3));
  std::vector<float> values(dl.begin<float>(), dl.end<float>());
  const float common = median(values);
  const auto changed = std::count_if(values.begin(), values.end(),
                                     [common](float v) { return std::abs(v - common) > kSameLuminance; });
  return static_cast<double>(changed) / static_cast<double>(values.size());
}

/// Number of images at the start (or the end) that do not differ from the first (or the last) one.
std::size_t still_run(std::span<const cv::Mat> images, bool from_end) {
  constexpr double kMostChange = 0.004;
  const auto at = [&](std::size_t i) { return images[from_end ? images.size() - 1 - i : i]; };
  const LogColour first = log_colour(at(0));
  std::size_t run = 1;
  while (run < images.size() && changed_share(first, log_colour(at(run))) < kMostChange) {
    ++run;
  }
  return run;
}

/// The pixels of the person, dilated by a margin for blur and for errors of the segmentation.
cv::Mat covered_by_person(const SceneSample& sample) {
  const int margin = std::max(1, sample.bgr.cols / 80);
  return person_area(sample.mask.empty() ? cut_person(sample.bgr, *sample.head) : sample.mask, margin);
}

/// The colours of the samples, with the changes of light, exposure and white balance between them
/// compensated: as if all had the light of the sample in the middle of the range of brightness.
std::vector<LogColour> compensated(std::span<const SceneSample> samples, std::span<const cv::Mat> scenes) {
  std::vector<LogColour> colours;
  std::vector<std::pair<double, std::size_t>> brightness;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    colours.push_back(log_colour(samples[i].bgr));
    brightness.emplace_back(cv::mean(colours.back().l, scenes[i])[0], i);
  }
  const auto middle = brightness.begin() + static_cast<std::ptrdiff_t>(brightness.size() / 2);
  std::nth_element(brightness.begin(), middle, brightness.end());
  const std::size_t reference = middle->second;
  const std::vector<cv::Mat> one{samples[reference].bgr};
  const BackgroundModel model = learn_background_model(one);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i != reference) {
      compensate(model, estimate_light(model, colours[i], scenes[i] & scenes[reference]), colours[i]);
    }
  }
  return colours;
}

/// The samples as colours with the trust in each pixel as background.
struct Series {
  std::vector<LogColour> colours;
  std::vector<cv::Mat> trust;  ///< CV_32FC1: 1 outside the person, near 0 inside
};

Series series_of(std::span<const SceneSample> samples) {
  constexpr float kInside = 0.05F;
  // An image without a detected head is only used if no head was detected in any image.
  const bool any_head =
      std::any_of(samples.begin(), samples.end(), [](const auto& s) { return s.head.has_value(); });
  const float no_head = any_head ? 0.0F : 0.5F;
  Series series;
  std::vector<cv::Mat> scenes;
  for (const SceneSample& sample : samples) {
    cv::Mat trust(sample.bgr.size(), CV_32FC1, cv::Scalar(no_head));
    cv::Mat scene(sample.bgr.size(), CV_8UC1, cv::Scalar(255));
    if (sample.head || !sample.mask.empty()) {
      const cv::Mat covered = covered_by_person(sample);
      trust.setTo(1.0F);
      trust.setTo(kInside, covered);
      scene.setTo(0, covered);
    }
    series.trust.push_back(trust);
    scenes.push_back(scene);
  }
  series.colours = compensated(samples, scenes);
  return series;
}

}  // namespace

std::pair<std::size_t, std::size_t> find_still_stretch(std::span<const cv::Mat> images) {
  constexpr std::size_t kMargin = 3;
  constexpr std::size_t kFewest = 8;
  if (images.size() < kFewest + kMargin) {
    return {0, 0};
  }
  const std::size_t start = still_run(images, false);
  if (start >= kFewest + kMargin) {
    return {0, start == images.size() ? start : start - kMargin};
  }
  const std::size_t end = still_run(images, true);
  if (end >= kFewest + kMargin) {
    return {images.size() - end + kMargin, end - kMargin};
  }
  return {0, 0};
}

BackgroundModel learn_around_person(std::span<const SceneSample> samples) {
  const Series series = series_of(samples);
  std::vector<cv::Mat> one{samples.front().bgr};
  // A model of the right size; all of it is replaced below, pixel by pixel.
  BackgroundModel model = learn_background_model(one);
  const std::size_t count = samples.size();
  const auto heads = std::count_if(samples.begin(), samples.end(),
                                   [](const auto& s) { return s.head.has_value() || !s.mask.empty(); });
  const float enough = heads > 0 && heads < 6 ? 0.9F : 1.4F;
  std::vector<float> u(count);
  std::vector<float> v(count);
  std::vector<float> l(count);
  std::vector<float> trust(count);
  for (int r = 0; r < model.valid.rows; ++r) {
    for (int c = 0; c < model.valid.cols; ++c) {
      for (std::size_t i = 0; i < count; ++i) {
        u[i] = series.colours[i].u.at<float>(r, c);
        v[i] = series.colours[i].v.at<float>(r, c);
        l[i] = series.colours[i].l.at<float>(r, c);
        trust[i] = series.trust[i].at<float>(r, c);
      }
      // The colour with the most support: each image votes for the colours similar to its own.
      float best = -1;
      float outside = 0;
      Eigen::Vector3f mean = Eigen::Vector3f::Zero();
      for (std::size_t i = 0; i < count; ++i) {
        float support = 0;
        std::size_t first = i;
        std::size_t last = i;
        Eigen::Vector3f sum = Eigen::Vector3f::Zero();
        for (std::size_t j = 0; j < count; ++j) {
          const bool same = std::abs(l[i] - l[j]) < kSameLuminance && std::abs(u[i] - u[j]) < kSameChroma &&
                            std::abs(v[i] - v[j]) < kSameChroma;
          if (same) {
            support += trust[j];
            first = std::min(first, j);
            last = std::max(last, j);
            sum += trust[j] * Eigen::Vector3f(u[j], v[j], l[j]);
          }
        }
        // Background is visible before and after anything that passes in front of it: a long span adds
        // support.
        const float span = static_cast<float>(last - first) * trust[i];
        if (support + 0.6F * span > best) {
          best = support + 0.6F * span;
          outside = support;
          mean = sum / support;
        }
      }
      model.mean.u.at<float>(r, c) = mean[0];
      model.mean.v.at<float>(r, c) = mean[1];
      model.mean.l.at<float>(r, c) = mean[2];
      const BackgroundNoise noise = background_noise(mean[2]);
      model.chroma_variance.at<float>(r, c) = noise.chroma;
      model.luminance_variance.at<float>(r, c) = noise.luminance;
      model.valid.at<unsigned char>(r, c) = outside >= enough ? 255 : 0;
    }
  }
  return model;
}

ColourMixture learn_surroundings(std::span<const SceneSample> samples) {
  // Sample pixels outside the person in three images.
  const Series series = series_of(samples);
  std::vector<Eigen::Vector3f> colours;
  constexpr std::size_t kMost = 3;
  const std::size_t step = std::max<std::size_t>(1, samples.size() / kMost);
  for (std::size_t i = 0; i < samples.size(); i += step) {
    if (!samples[i].head && samples[i].mask.empty()) {
      continue;
    }
    const LogColour& image = series.colours[i];
    const cv::Mat& trust = series.trust[i];
    const int stride = std::max(1, samples[i].bgr.cols / 80);
    for (int r = 0; r < trust.rows; r += stride) {
      for (int c = 0; c < trust.cols; c += stride) {
        if (trust.at<float>(r, c) >= 1.0F) {
          colours.emplace_back(image.u.at<float>(r, c), image.v.at<float>(r, c), image.l.at<float>(r, c));
        }
      }
    }
  }
  if (colours.size() < 50) {
    return {};
  }
  return fit_mixture(colours, 6,
                     ColourTolerance{.chroma = 0.05F, .luminance = 0.12F, .stretch = 1.2F, .slope = 0.3F});
}

}  // namespace telemime
