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

/// Smallest deviations: 8-bit steps, compression, flicker. Without them a still scene has zero variance.
constexpr float kChromaFloor = 0.018F;
constexpr float kLuminanceFloor = 0.022F;
/// Grey levels of noise assumed in every channel; on the logarithmic scale dark pixels are noisier.
constexpr float kChannelNoise = 1.5F;

float noise_variance(float l) {
  const float deviation = kChannelNoise / std::exp(l);
  return deviation * deviation;
}

float median_of(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

BackgroundModel learn_background_model(std::span<const cv::Mat> pictures) {
  if (pictures.empty()) {
    throw Error(ErrorKind::usage, "a background needs at least one picture without a person");
  }
  const cv::Size size = pictures.front().size();
  std::array<cv::Mat, 3> sum;
  std::array<cv::Mat, 3> sum2;
  for (std::size_t i = 0; i < 3; ++i) {
    sum[i] = cv::Mat::zeros(size, CV_32FC1);
    sum2[i] = cv::Mat::zeros(size, CV_32FC1);
  }
  // Squares are summed about the first picture: the variance is small beside the mean.
  const LogColour origin = log_colour(pictures.front());
  const std::array<const cv::Mat*, 3> zero{&origin.u, &origin.v, &origin.l};
  for (const cv::Mat& picture : pictures) {
    if (picture.size() != size) {
      throw Error(ErrorKind::usage, "the pictures of the background differ in size");
    }
    const LogColour colour = log_colour(picture);
    const std::array<const cv::Mat*, 3> planes{&colour.u, &colour.v, &colour.l};
    for (std::size_t i = 0; i < 3; ++i) {
      const cv::Mat d = *planes[i] - *zero[i];
      sum[i] += d;
      sum2[i] += d.mul(d);
    }
  }
  const auto n = static_cast<double>(pictures.size());
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

BackgroundEnergy background_energy(const BackgroundModel& model, const LogColour& picture,
                                   const ShadowRange& shadow, const cv::Mat& unknown) {
  const cv::Size size = model.valid.size();
  BackgroundEnergy out{cv::Mat(size, CV_32FC1), cv::Mat(size, CV_8UC1)};
  const float darkest = std::log(shadow.darkest);
  const float extra = shadow.chroma * shadow.chroma;
  // In a shadow l falls off exponentially, mild shadows being the most; of the three ln 2 pi that all
  // energies leave out, this density has only two.
  const float constant = 2 * std::log(shadow.typical) - std::log(2 * std::acos(-1.0F)) + shadow.prior_cost;
  const float slope = -2 / shadow.typical;
  cv::Mat logs(2, size.width, CV_32FC1);
  cv::Mat argument(2, size.width, CV_32FC1);
  for (int r = 0; r < size.height; ++r) {
    const auto* u = picture.u.ptr<float>(r);
    const auto* v = picture.v.ptr<float>(r);
    const auto* l = picture.l.ptr<float>(r);
    const auto* mu = model.mean.u.ptr<float>(r);
    const auto* mv = model.mean.v.ptr<float>(r);
    const auto* ml = model.mean.l.ptr<float>(r);
    const auto* vc = model.chroma_variance.ptr<float>(r);
    const auto* vl = model.luminance_variance.ptr<float>(r);
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
      // Outside the range of shadows the cost grows with the square of the distance to its nearer end.
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
  if (!unknown.empty()) {
    const cv::Mat covered = model.valid == 0;
    unknown.copyTo(out.energy, covered);
    out.shaded.setTo(0, covered);
  }
  return out;
}

LogColour estimate_gain(const BackgroundModel& model, const LogColour& picture, const cv::Mat& believed) {
  constexpr int kAcross = 8;
  constexpr int kDown = 6;
  constexpr std::size_t kCells = 48;
  static_assert(kCells == std::size_t{kAcross} * std::size_t{kDown});
  constexpr std::array<float, 3> kMostLocal{0.06F, 0.06F, 0.12F};
  const cv::Size size = model.valid.size();
  // About five thousand pixels are plenty for 48 medians.
  const int step =
      std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(size.area()) / 5000))));
  std::array<std::array<std::vector<float>, 3>, kCells> differences;
  for (int r = step / 2; r < size.height; r += step) {
    const int row_of_cell = r * kDown / size.height * kAcross;
    for (int c = step / 2; c < size.width; c += step) {
      if (model.valid.at<unsigned char>(r, c) == 0 ||
          (!believed.empty() && believed.at<unsigned char>(r, c) == 0)) {
        continue;
      }
      const int index = row_of_cell + c * kAcross / size.width;
      auto& cell = differences[static_cast<std::size_t>(index)];
      cell[0].push_back(picture.u.at<float>(r, c) - model.mean.u.at<float>(r, c));
      cell[1].push_back(picture.v.at<float>(r, c) - model.mean.v.at<float>(r, c));
      cell[2].push_back(picture.l.at<float>(r, c) - model.mean.l.at<float>(r, c));
    }
  }
  std::array<std::vector<float>, 3> everything;
  std::array<float, 3> whole{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (const auto& cell : differences) {
      everything[i].insert(everything[i].end(), cell[i].begin(), cell[i].end());
    }
    whole[i] = everything[i].empty() ? 0.0F : median_of(everything[i]);
  }
  cv::Mat medians = cv::Mat::zeros(kDown, kAcross, CV_32FC3);
  cv::Mat weights = cv::Mat::zeros(kDown, kAcross, CV_32FC1);
  for (int cell = 0; cell < kAcross * kDown; ++cell) {
    auto& planes = differences[static_cast<std::size_t>(cell)];
    const std::size_t count = planes[0].size();
    if (count < 12) {
      continue;
    }
    std::array<float, 3> own{};
    float farthest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      own[i] = median_of(planes[i]);
      farthest = std::max(farthest, std::abs(own[i] - whole[i]) / kMostLocal[i]);
    }
    // A cell that differs by more than lamps do was entered by something.
    if (farthest > 1) {
      continue;
    }
    const auto weight = static_cast<float>(count);
    weights.at<float>(cell / kAcross, cell % kAcross) = weight;
    medians.at<cv::Vec3f>(cell / kAcross, cell % kAcross) = weight * cv::Vec3f(own[0], own[1], own[2]);
  }
  // Two blurs of sums and weights: near cells decide where there are any, far ones where there are none.
  cv::Mat near;
  cv::Mat near_weight;
  cv::GaussianBlur(medians, near, cv::Size(3, 3), 0.7, 0.7, cv::BORDER_CONSTANT);
  cv::GaussianBlur(weights, near_weight, cv::Size(3, 3), 0.7, 0.7, cv::BORDER_CONSTANT);
  cv::Mat grid = cv::Mat::zeros(kDown, kAcross, CV_32FC3);
  for (int cell = 0; !everything[0].empty() && cell < kAcross * kDown; ++cell) {
    const int r = cell / kAcross;
    const int c = cell % kAcross;
    // Pixels' worth of trust in the median of the whole picture. Before anything is believed a cell may be
    // all person: then only the whole picture is asked.
    const float far = believed.empty() ? 1e9F : 3.0F;
    for (int i = 0; i < 3; ++i) {
      const float mean = whole[static_cast<std::size_t>(i)];
      grid.at<cv::Vec3f>(r, c)[i] =
          (near.at<cv::Vec3f>(r, c)[i] + far * mean) / (near_weight.at<float>(r, c) + far);
    }
  }
  cv::Mat wide;
  cv::resize(grid, wide, size, 0, 0, cv::INTER_LINEAR);
  std::array<cv::Mat, 3> planes;
  cv::split(wide, planes.data());
  return {planes[0], planes[1], planes[2]};
}

void adapt_background(BackgroundModel& model, const LogColour& picture, const cv::Mat& where, float rate) {
  constexpr int kFramesToBelieve = 12;
  constexpr float kSteady = 0.1F;
  for (int r = 0; r < model.valid.rows; ++r) {
    const auto* w = where.ptr<unsigned char>(r);
    auto* valid = model.valid.ptr<unsigned char>(r);
    auto* seen = model.seen.ptr<unsigned char>(r);
    const auto* u = picture.u.ptr<float>(r);
    const auto* v = picture.v.ptr<float>(r);
    const auto* l = picture.l.ptr<float>(r);
    auto* mu = model.mean.u.ptr<float>(r);
    auto* mv = model.mean.v.ptr<float>(r);
    auto* ml = model.mean.l.ptr<float>(r);
    for (int c = 0; c < model.valid.cols; ++c) {
      float k = w[c] != 0 ? rate : 0.0F;
      if (valid[c] == 0) {
        const float step = std::abs(u[c] - mu[c]) + std::abs(v[c] - mv[c]) + std::abs(l[c] - ml[c]);
        const bool steady = seen[c] > 0 && step < 3 * kSteady;
        seen[c] = static_cast<unsigned char>(w[c] == 0 ? 0 : (steady ? seen[c] + 1 : 1));
        k = w[c] == 0 ? 0.0F : 1.0F / static_cast<float>(seen[c]);
        valid[c] = seen[c] >= kFramesToBelieve ? 255 : 0;
      }
      mu[c] += k * (u[c] - mu[c]);
      mv[c] += k * (v[c] - mv[c]);
      ml[c] += k * (l[c] - ml[c]);
    }
  }
}

}  // namespace telemime
