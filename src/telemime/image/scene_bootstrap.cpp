// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/scene_bootstrap.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/image/person_shape.h"

namespace telemime {
namespace {

/// Two colours of one thing seen twice by a static camera differ by less than this.
constexpr float kSameChroma = 0.09F;
constexpr float kSameLuminance = 0.12F;

/// Share of pixels that differ by more than noise, a common change of light undone.
double changed_share(const LogColour& a, const LogColour& b) {
  cv::Mat dl = b.l - a.l;
  cv::blur(dl, dl, cv::Size(3, 3));
  std::vector<float> values(dl.begin<float>(), dl.end<float>());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const float common = *middle;
  const auto changed = std::count_if(values.begin(), values.end(),
                                     [common](float v) { return std::abs(v - common) > kSameLuminance; });
  return static_cast<double>(changed) / static_cast<double>(values.size());
}

std::size_t still_run(std::span<const cv::Mat> pictures, bool from_end) {
  constexpr double kMostChange = 0.004;
  const auto at = [&](std::size_t i) { return pictures[from_end ? pictures.size() - 1 - i : i]; };
  const LogColour first = log_colour(at(0));
  std::size_t run = 1;
  while (run < pictures.size() && changed_share(first, log_colour(at(run))) < kMostChange) {
    ++run;
  }
  return run;
}

/// Person pixels, grown by a margin: blur and the cut's own errors.
cv::Mat covered_by_person(const SceneSample& sample) {
  cv::Mat covered = cut_person(sample.bgr, *sample.head);
  const int margin = std::max(1, sample.bgr.cols / 80);
  cv::dilate(covered, covered,
             cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(2 * margin + 1, 2 * margin + 1)));
  return covered;
}

struct Series {
  std::vector<LogColour> colours;
  std::vector<cv::Mat> trust;  ///< CV_32FC1: 1 outside the person, little inside
};

Series series_of(std::span<const SceneSample> samples) {
  constexpr float kInside = 0.05F;
  // A picture in which no head was found is of use only when that is so in all of them.
  const bool any_head =
      std::any_of(samples.begin(), samples.end(), [](const auto& s) { return s.head.has_value(); });
  const float no_head = any_head ? 0.0F : 0.5F;
  Series series;
  for (const SceneSample& sample : samples) {
    series.colours.push_back(log_colour(sample.bgr));
    cv::Mat trust(sample.bgr.size(), CV_32FC1, cv::Scalar(no_head));
    if (sample.head) {
      trust.setTo(1.0F);
      trust.setTo(kInside, covered_by_person(sample));
    }
    series.trust.push_back(trust);
  }
  return series;
}

}  // namespace

std::pair<std::size_t, std::size_t> find_still_stretch(std::span<const cv::Mat> pictures) {
  constexpr std::size_t kMargin = 3;
  constexpr std::size_t kFewest = 8;
  if (pictures.size() < kFewest + kMargin) {
    return {0, 0};
  }
  const std::size_t start = still_run(pictures, false);
  if (start >= kFewest + kMargin) {
    return {0, start == pictures.size() ? start : start - kMargin};
  }
  const std::size_t end = still_run(pictures, true);
  if (end >= kFewest + kMargin) {
    return {pictures.size() - end + kMargin, end - kMargin};
  }
  return {0, 0};
}

BackgroundModel learn_around_person(std::span<const SceneSample> samples) {
  const Series series = series_of(samples);
  std::vector<cv::Mat> one{samples.front().bgr};
  // Starts from the noise of one picture; means and validity are replaced pixel by pixel.
  BackgroundModel model = learn_background_model(one);
  const std::size_t count = samples.size();
  const auto heads =
      std::count_if(samples.begin(), samples.end(), [](const auto& s) { return s.head.has_value(); });
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
        // The scene is there before, between and after what passes in front of it: a long span counts.
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
      model.valid.at<unsigned char>(r, c) = outside >= enough ? 255 : 0;
    }
  }
  return model;
}

ColourMixture learn_surroundings(std::span<const SceneSample> samples) {
  std::vector<Eigen::Vector3f> colours;
  constexpr std::size_t kMost = 3;
  const std::size_t step = std::max<std::size_t>(1, samples.size() / kMost);
  for (std::size_t i = 0; i < samples.size(); i += step) {
    if (!samples[i].head) {
      continue;
    }
    const LogColour picture = log_colour(samples[i].bgr);
    const cv::Mat covered = covered_by_person(samples[i]);
    const int stride = std::max(1, samples[i].bgr.cols / 80);
    for (int r = 0; r < covered.rows; r += stride) {
      for (int c = 0; c < covered.cols; c += stride) {
        if (covered.at<unsigned char>(r, c) == 0) {
          colours.emplace_back(picture.u.at<float>(r, c), picture.v.at<float>(r, c),
                               picture.l.at<float>(r, c));
        }
      }
    }
  }
  if (colours.size() < 50) {
    return {};
  }
  return fit_mixture(colours, 6, ColourTolerance{0.05F, 0.12F, 1.2F, 0.3F});
}

}  // namespace telemime
