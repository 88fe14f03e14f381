// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/background_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

/// Noise floors (standard deviations) for quantisation, compression and flicker: without them a still scene
/// would have no variance.
constexpr float kChromaFloor = 0.018F;
constexpr float kLuminanceFloor = 0.022F;
/// Assumed noise of each channel in grey levels. On the logarithmic scale, dark pixels are noisier.
constexpr float kChannelNoise = 1.5F;

/// Variance of the logarithm of a channel at luminance `l`.
float noise_variance(float l) {
  const float deviation = kChannelNoise / std::exp(l);
  return deviation * deviation;
}

}  // namespace

BackgroundModel learn_background_model(std::span<const cv::Mat> images) {
  if (images.empty()) {
    throw Error(ErrorKind::usage, "the background model needs at least one image without a person");
  }
  const cv::Size size = images.front().size();
  std::array<cv::Mat, 3> sum;
  std::array<cv::Mat, 3> sum2;
  for (std::size_t i = 0; i < 3; ++i) {
    sum[i] = cv::Mat::zeros(size, CV_32FC1);
    sum2[i] = cv::Mat::zeros(size, CV_32FC1);
  }
  // Sum the differences from the first image, not the values: the variance is small compared to the mean.
  const LogColour origin = log_colour(images.front());
  const std::array<const cv::Mat*, 3> zero{&origin.u, &origin.v, &origin.l};
  for (const cv::Mat& image : images) {
    if (image.size() != size) {
      throw Error(ErrorKind::usage, "the background images differ in size");
    }
    const LogColour colour = log_colour(image);
    const std::array<const cv::Mat*, 3> planes{&colour.u, &colour.v, &colour.l};
    for (std::size_t i = 0; i < 3; ++i) {
      const cv::Mat d = *planes[i] - *zero[i];
      sum[i] += d;
      sum2[i] += d.mul(d);
    }
  }
  // Means and variances.
  const auto n = static_cast<double>(images.size());
  std::array<cv::Mat, 3> variance;
  for (std::size_t i = 0; i < 3; ++i) {
    sum[i] /= n;
    variance[i] = sum2[i] / n - sum[i].mul(sum[i]);
  }
  BackgroundModel model;
  model.mean = {origin.u + sum[0], origin.v + sum[1], origin.l + sum[2]};
  model.chroma_variance = 0.5 * (variance[0] + variance[1]);
  model.luminance_variance = variance[2];
  model.valid = cv::Mat(size, CV_8UC1, cv::Scalar(255));
  model.seen = cv::Mat::zeros(size, CV_8UC1);
  // Add the noise floor.
  for (int r = 0; r < size.height; ++r) {
    const auto* l = model.mean.l.ptr<float>(r);
    auto* chroma = model.chroma_variance.ptr<float>(r);
    auto* luminance = model.luminance_variance.ptr<float>(r);
    for (int c = 0; c < size.width; ++c) {
      const float noise = noise_variance(l[c]);
      chroma[c] = std::max(chroma[c], 0.0F) + kChromaFloor * kChromaFloor + 2 * noise;
      luminance[c] = std::max(luminance[c], 0.0F) + kLuminanceFloor * kLuminanceFloor + noise / 3;
    }
  }
  return model;
}

BackgroundEnergy background_energy(const BackgroundModel& model, const LogColour& image,
                                   const ShadowRange& shadow, const cv::Mat& unknown) {
  const cv::Size size = model.valid.size();
  BackgroundEnergy out{cv::Mat(size, CV_32FC1), cv::Mat(size, CV_8UC1)};
  const float darkest = std::log(shadow.darkest);
  const float extra = shadow.chroma * shadow.chroma;
  // The darkening in a shadow has an exponential density. It lacks one of the three ln 2 pi that all energies
  // omit.
  const float constant = 2 * std::log(shadow.typical) - std::log(2 * std::acos(-1.0F)) + shadow.prior_cost;
  const float slope = -2 / shadow.typical;
  cv::Mat logs(2, size.width, CV_32FC1);
  cv::Mat argument(2, size.width, CV_32FC1);
  for (int r = 0; r < size.height; ++r) {
    const auto* u = image.u.ptr<float>(r);
    const auto* v = image.v.ptr<float>(r);
    const auto* l = image.l.ptr<float>(r);
    const auto* mu = model.mean.u.ptr<float>(r);
    const auto* mv = model.mean.v.ptr<float>(r);
    const auto* ml = model.mean.l.ptr<float>(r);
    const auto* vc = model.chroma_variance.ptr<float>(r);
    const auto* vl = model.luminance_variance.ptr<float>(r);
    // The logarithms of a row at once: cv::log is vectorised.
    auto* a0 = argument.ptr<float>(0);
    auto* a1 = argument.ptr<float>(1);
    for (int c = 0; c < size.width; ++c) {
      a0[c] = vc[c] * vc[c] * vl[c];
      a1[c] = vc[c] + extra;
    }
    cv::log(argument, logs);
    const auto* log_plain = logs.ptr<float>(0);
    const auto* log_shadow = logs.ptr<float>(1);
    auto* e = out.energy.ptr<float>(r);
    auto* s = out.shaded.ptr<unsigned char>(r);
    for (int c = 0; c < size.width; ++c) {
      const float du = u[c] - mu[c];
      const float dv = v[c] - mv[c];
      const float dl = l[c] - ml[c];
      const float chroma2 = du * du + dv * dv;
      const float plain = chroma2 / vc[c] + dl * dl / vl[c] + log_plain[c];
      // Outside the range of shadows, the cost grows quadratically with the distance to the range.
      const float above = dl > 0 ? dl : 0;
      const float below = dl < darkest ? darkest - dl : 0;
      const float outside = above + below;
      const float shade = chroma2 / (vc[c] + extra) + outside * outside / vl[c] + 2 * log_shadow[c] +
                          constant + slope * (dl < 0 ? (dl > darkest ? dl : darkest) : 0.0F);
      const float best = plain < shade ? plain : shade;
      e[c] = best;
      s[c] = shade < plain ? 255 : 0;
    }
  }
  // Invalid pixels.
  if (!unknown.empty()) {
    const cv::Mat covered = model.valid == 0;
    unknown.copyTo(out.energy, covered);
    out.shaded.setTo(0, covered);
  }
  return out;
}

LogColour estimate_gain(const BackgroundModel& model, const LogColour& image, const cv::Mat& background) {
  constexpr int kAcross = 8;
  constexpr int kDown = 6;
  constexpr std::size_t kCells = 48;
  static_assert(kCells == std::size_t{kAcross} * std::size_t{kDown});
  constexpr std::array<float, 3> kLargestLocal{0.06F, 0.06F, 0.12F};
  const cv::Size size = model.valid.size();
  // Differences of about 5000 pixels, by grid cell.
  const int step =
      std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(size.area()) / 5000))));
  std::array<std::array<std::vector<float>, 3>, kCells> differences;
  for (int r = step / 2; r < size.height; r += step) {
    const int row_of_cell = r * kDown / size.height * kAcross;
    for (int c = step / 2; c < size.width; c += step) {
      if (model.valid.at<unsigned char>(r, c) == 0 ||
          (!background.empty() && background.at<unsigned char>(r, c) == 0)) {
        continue;
      }
      const int index = row_of_cell + c * kAcross / size.width;
      auto& cell = differences[static_cast<std::size_t>(index)];
      cell[0].push_back(image.u.at<float>(r, c) - model.mean.u.at<float>(r, c));
      cell[1].push_back(image.v.at<float>(r, c) - model.mean.v.at<float>(r, c));
      cell[2].push_back(image.l.at<float>(r, c) - model.mean.l.at<float>(r, c));
    }
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
  cv::Mat medians = cv::Mat::zeros(kDown, kAcross, CV_32FC3);
  cv::Mat weights = cv::Mat::zeros(kDown, kAcross, CV_32FC1);
  for (int cell = 0; cell < kAcross * kDown; ++cell) {
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
    weights.at<float>(cell / kAcross, cell % kAcross) = weight;
    medians.at<cv::Vec3f>(cell / kAcross, cell % kAcross) = weight * cv::Vec3f(local[0], local[1], local[2]);
  }
  // Smooth over neighbouring cells; where they have few pixels, the global median counts more.
  cv::Mat near;
  cv::Mat near_weight;
  cv::GaussianBlur(medians, near, cv::Size(3, 3), 0.7, 0.7, cv::BORDER_CONSTANT);
  cv::GaussianBlur(weights, near_weight, cv::Size(3, 3), 0.7, 0.7, cv::BORDER_CONSTANT);
  cv::Mat grid = cv::Mat::zeros(kDown, kAcross, CV_32FC3);
  for (int cell = 0; !all_differences[0].empty() && cell < kAcross * kDown; ++cell) {
    const int r = cell / kAcross;
    const int c = cell % kAcross;
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
  return {planes[0], planes[1], planes[2]};
}

void adapt_background(BackgroundModel& model, const LogColour& image, const cv::Mat& where, float rate) {
  constexpr int kFramesToLearn = 12;
  constexpr float kSteady = 0.1F;
  for (int r = 0; r < model.valid.rows; ++r) {
    const auto* w = where.ptr<unsigned char>(r);
    auto* valid = model.valid.ptr<unsigned char>(r);
    auto* seen = model.seen.ptr<unsigned char>(r);
    const auto* u = image.u.ptr<float>(r);
    const auto* v = image.v.ptr<float>(r);
    const auto* l = image.l.ptr<float>(r);
    auto* mu = model.mean.u.ptr<float>(r);
    auto* mv = model.mean.v.ptr<float>(r);
    auto* ml = model.mean.l.ptr<float>(r);
    for (int c = 0; c < model.valid.cols; ++c) {
      float k = w[c] != 0 ? rate : 0.0F;
      // An invalid pixel averages its colours until it has been steady for long enough.
      if (valid[c] == 0) {
        const float step = std::abs(u[c] - mu[c]) + std::abs(v[c] - mv[c]) + std::abs(l[c] - ml[c]);
        const bool steady = seen[c] > 0 && step < 3 * kSteady;
        seen[c] = static_cast<unsigned char>(w[c] == 0 ? 0 : (steady ? seen[c] + 1 : 1));
        k = w[c] == 0 ? 0.0F : 1.0F / static_cast<float>(seen[c]);
        valid[c] = seen[c] >= kFramesToLearn ? 255 : 0;
      }
      mu[c] += k * (u[c] - mu[c]);
      mv[c] += k * (v[c] - mv[c]);
      ml[c] += k * (l[c] - ml[c]);
    }
  }
}

}  // namespace telemime
