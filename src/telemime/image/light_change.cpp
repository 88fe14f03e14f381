// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/light_change.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace telemime {
namespace {

/// Grey levels below and above which a channel may have been darker or brighter than the camera can tell.
constexpr float kLeastLevel = 10.0F;
constexpr float kMostLevel = 248.0F;

using Channels = std::array<float, 3>;  ///< blue, green, red

/// ln(grey level + offset) of the channels of a pixel.
Channels logarithms(float u, float v, float l) {
  const float green = l - (u + v) / 3;
  return {green + v, green, green + u};
}

Channels grey_levels(const LogColour& image, int r, int c) {
  Channels out = logarithms(image.u.at<float>(r, c), image.v.at<float>(r, c), image.l.at<float>(r, c));
  for (float& value : out) {
    value = std::exp(value) - kLogColourOffset;
  }
  return out;
}

float least(const Channels& channels) {
  return std::min(std::min(channels[0], channels[1]), channels[2]);
}

float most(const Channels& channels) {
  return std::max(std::max(channels[0], channels[1]), channels[2]);
}

/// A pixel of the background: grey levels in the light of the model, and now.
struct Sample {
  cv::Point at;
  Channels before{};
  Channels now{};
};

/// About 5000 pixels of the background that are not clipped.
std::vector<Sample> samples_of(const BackgroundModel& model, const LogColour& image,
                               const cv::Mat& background) {
  const cv::Size size = model.valid.size();
  const int step =
      std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(size.area()) / 5000))));
  std::vector<Sample> samples;
  for (int r = step / 2; r < size.height; r += step) {
    for (int c = step / 2; c < size.width; c += step) {
      if (model.valid.at<unsigned char>(r, c) == 0 ||
          (!background.empty() && background.at<unsigned char>(r, c) == 0)) {
        continue;
      }
      const Sample sample{
          .at = {c, r}, .before = grey_levels(model.mean, r, c), .now = grey_levels(image, r, c)};
      if (std::min(least(sample.now), least(sample.before)) >= kLeastLevel &&
          std::max(most(sample.now), most(sample.before)) <= kMostLevel) {
        samples.push_back(sample);
      }
    }
  }
  return samples;
}

/// The offset of each channel, or 0 where a gain alone explains the image nearly as well.
std::array<float, 3> offset_of(const std::vector<Sample>& samples) {
  constexpr std::size_t kClasses = 12;
  constexpr std::size_t kFewest = 10;  // samples of a class
  constexpr float kSmallest = 3.0F;    // grey levels: less may be noise
  constexpr float kLargest = 120.0F;
  constexpr double kNarrowest = 20.0;  // standard deviation of the classes' grey levels
  constexpr double kBetter = 0.4;
  if (samples.size() < kClasses * kFewest) {
    return {};
  }
  constexpr std::size_t kEnough = 1500;
  const std::size_t step = std::max<std::size_t>(1, samples.size() / kEnough);
  std::array<float, 3> offset{};
  double error_of_gain = 0.0;
  double error_of_line = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    // Medians of classes of the same size and similar grey level: what moved in front of the background is an
    // outlier in each.
    std::vector<std::pair<float, float>> levels;
    for (std::size_t j = 0; j < samples.size(); j += step) {
      levels.emplace_back(samples[j].before[i], samples[j].now[i]);
    }
    std::sort(levels.begin(), levels.end());
    std::array<double, kClasses> x{};
    std::array<double, kClasses> y{};
    for (std::size_t k = 0; k < kClasses; ++k) {
      std::vector<float> before;
      std::vector<float> now;
      for (std::size_t j = k * levels.size() / kClasses; j < (k + 1) * levels.size() / kClasses; ++j) {
        before.push_back(levels[j].first);
        now.push_back(levels[j].second);
      }
      x[k] = median(before);
      y[k] = median(now);
    }
    // The line through them, and the line that also passes through black.
    double mx = 0.0;
    double my = 0.0;
    for (std::size_t k = 0; k < kClasses; ++k) {
      mx += x[k] / kClasses;
      my += y[k] / kClasses;
    }
    double xx = 0.0;
    double xy = 0.0;
    double xx0 = 0.0;
    double xy0 = 0.0;
    for (std::size_t k = 0; k < kClasses; ++k) {
      xx += (x[k] - mx) * (x[k] - mx);
      xy += (x[k] - mx) * (y[k] - my);
      xx0 += x[k] * x[k];
      xy0 += x[k] * y[k];
    }
    if (xx < kClasses * kNarrowest * kNarrowest || xy <= 0.0) {
      return {};
    }
    const double slope = xy / xx;
    offset[i] = std::clamp(static_cast<float>(my - slope * mx), -kLargest, kLargest);
    for (std::size_t k = 0; k < kClasses; ++k) {
      const double by_line = y[k] - my - slope * (x[k] - mx);
      const double by_gain = y[k] - xy0 / xx0 * x[k];
      error_of_line += by_line * by_line;
      error_of_gain += by_gain * by_gain;
    }
  }
  const bool large = std::max(most(offset), -least(offset)) > kSmallest;
  return large && error_of_line < kBetter * error_of_gain ? offset : std::array<float, 3>{};
}

}  // namespace

LightChange estimate_light(const BackgroundModel& model, const LogColour& image, const cv::Mat& background) {
  constexpr int kCellsAcross = 8;
  constexpr int kCellsDown = 6;
  constexpr std::size_t kCells = 48;
  static_assert(kCells == std::size_t{kCellsAcross} * std::size_t{kCellsDown});
  constexpr std::array<float, 3> kLargestLocal{0.06F, 0.06F, 0.12F};
  const cv::Size size = model.valid.size();
  const std::vector<Sample> samples = samples_of(model, image, background);
  LightChange out;
  out.offset = offset_of(samples);
  // Logarithms of the ratios, by grid cell.
  std::array<std::array<std::vector<float>, 3>, kCells> differences;
  for (const Sample& sample : samples) {
    Channels logs{};
    bool positive = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const float now = sample.now[i] - out.offset[i];
      positive = positive && now > 1.0F;
      logs[i] = std::log(std::max(now, 1.0F) / sample.before[i]);
    }
    if (!positive) {
      continue;
    }
    const int index =
        sample.at.y * kCellsDown / size.height * kCellsAcross + sample.at.x * kCellsAcross / size.width;
    auto& cell = differences[static_cast<std::size_t>(index)];
    cell[0].push_back(logs[2] - logs[1]);
    cell[1].push_back(logs[0] - logs[1]);
    cell[2].push_back((logs[0] + logs[1] + logs[2]) / 3);
  }
  // The median of all pixels.
  std::array<std::vector<float>, 3> all_differences;
  std::array<float, 3> global{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (const auto& cell : differences) {
      all_differences[i].insert(all_differences[i].end(), cell[i].begin(), cell[i].end());
    }
    global[i] = all_differences[i].empty() ? 0.0F : median(all_differences[i]);
  }
  // The median of each cell, weighted by its number of pixels.
  cv::Mat medians = cv::Mat::zeros(kCellsDown, kCellsAcross, CV_32FC3);
  cv::Mat weights = cv::Mat::zeros(kCellsDown, kCellsAcross, CV_32FC1);
  for (int cell = 0; cell < kCellsAcross * kCellsDown; ++cell) {
    auto& planes = differences[static_cast<std::size_t>(cell)];
    const std::size_t count = planes[0].size();
    if (count < 12) {
      continue;
    }
    std::array<float, 3> local{};
    float farthest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      local[i] = median(planes[i]);
      farthest = std::max(farthest, std::abs(local[i] - global[i]) / kLargestLocal[i]);
    }
    // A difference larger than that of a lamp means that an object is in the cell.
    if (farthest > 1) {
      continue;
    }
    const auto weight = static_cast<float>(count);
    weights.at<float>(cell / kCellsAcross, cell % kCellsAcross) = weight;
    medians.at<cv::Vec3f>(cell / kCellsAcross, cell % kCellsAcross) =
        weight * cv::Vec3f(local[0], local[1], local[2]);
  }
  // Smooth over neighbouring cells; where they have few pixels, the global median counts more.
  cv::Mat near;
  cv::Mat near_weight;
  cv::GaussianBlur(medians, near, cv::Size(3, 3), 0.7, 0.7, cv::BORDER_CONSTANT);
  cv::GaussianBlur(weights, near_weight, cv::Size(3, 3), 0.7, 0.7, cv::BORDER_CONSTANT);
  cv::Mat grid = cv::Mat::zeros(kCellsDown, kCellsAcross, CV_32FC3);
  for (int cell = 0; !all_differences[0].empty() && cell < kCellsAcross * kCellsDown; ++cell) {
    const int r = cell / kCellsAcross;
    const int c = cell % kCellsAcross;
    // Weight of the global median in pixels. Before the background is known, a cell may show only the person,
    // so the global median alone counts.
    const float far = background.empty() ? 1e9F : 3.0F;
    for (int i = 0; i < 3; ++i) {
      const float mean = global[static_cast<std::size_t>(i)];
      grid.at<cv::Vec3f>(r, c)[i] =
          (near.at<cv::Vec3f>(r, c)[i] + far * mean) / (near_weight.at<float>(r, c) + far);
    }
  }
  // Interpolate the grid to the image.
  cv::Mat wide;
  cv::resize(grid, wide, size, 0, 0, cv::INTER_LINEAR);
  std::array<cv::Mat, 3> planes;
  cv::split(wide, planes.data());
  out.gain = {planes[0], planes[1], planes[2]};
  return out;
}

void compensate(const BackgroundModel& model, const LightChange& light, LogColour& image) {
  constexpr float kCrushed = 4.0F;
  const float white = std::log(kMostLevel + kLogColourOffset);
  const float black = std::log(kCrushed + kLogColourOffset);
  const int columns = model.valid.cols;
  constexpr int kPlanes = 3;
  cv::Mat before(kPlanes, columns,
                 CV_32FC1);  // logarithms of the image as it is, of the model, of the factors
  cv::Mat known(kPlanes, columns, CV_32FC1);
  cv::Mat factors(kPlanes, columns, CV_32FC1);
  cv::Mat levels(kPlanes, columns, CV_32FC1);
  const auto split = [columns](const LogColour& from, int row, float sign, cv::Mat& to) {
    const auto* u = from.u.ptr<float>(row);
    const auto* v = from.v.ptr<float>(row);
    const auto* l = from.l.ptr<float>(row);
    auto* blue = to.ptr<float>(0);
    auto* green = to.ptr<float>(1);
    auto* red = to.ptr<float>(2);
    for (int c = 0; c < columns; ++c) {
      const float g = l[c] - (u[c] + v[c]) * (1.0F / 3.0F);
      blue[c] = sign * (g + v[c]);
      green[c] = sign * g;
      red[c] = sign * (g + u[c]);
    }
  };
  for (int r = 0; r < model.valid.rows; ++r) {
    split(image, r, 1.0F, before);
    split(model.mean, r, 1.0F, known);
    split(light.gain, r, -1.0F, factors);
    // Exponentials and logarithms of a row at once: OpenCV's are vectorised.
    cv::exp(before, levels);
    cv::exp(factors, factors);
    const auto* valid = model.valid.ptr<unsigned char>(r);
    for (int i = 0; i < kPlanes; ++i) {
      auto* level = levels.ptr<float>(i);
      const auto* factor = factors.ptr<float>(i);
      const float less = kLogColourOffset + light.offset[static_cast<std::size_t>(i)];
      for (int c = 0; c < columns; ++c) {
        const float scaled = (level[c] - less) * factor[c];
        level[c] = (scaled > 0.0F ? scaled : 0.0F) + kLogColourOffset;
      }
    }
    cv::log(levels, levels);
    // Where a channel is clipped, now or in the model, anything beyond agrees with the model.
    for (int i = 0; i < kPlanes; ++i) {
      auto* now = levels.ptr<float>(i);
      const auto* raw = before.ptr<float>(i);
      const auto* mean = known.ptr<float>(i);
      for (int c = 0; c < columns; ++c) {
        const bool rises = raw[c] > white || mean[c] < black;
        const bool falls = raw[c] < black || mean[c] > white;
        const float at_least = rises && now[c] < mean[c] ? mean[c] : now[c];
        const float clipped = falls && at_least > mean[c] ? mean[c] : at_least;
        now[c] = valid[c] != 0 ? clipped : now[c];
      }
    }
    auto* u = image.u.ptr<float>(r);
    auto* v = image.v.ptr<float>(r);
    auto* l = image.l.ptr<float>(r);
    const auto* blue = levels.ptr<float>(0);
    const auto* green = levels.ptr<float>(1);
    const auto* red = levels.ptr<float>(2);
    for (int c = 0; c < columns; ++c) {
      u[c] = red[c] - green[c];
      v[c] = blue[c] - green[c];
      l[c] = (blue[c] + green[c] + red[c]) * (1.0F / 3.0F);
    }
  }
}

}  // namespace telemime
