// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/background_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "telemime/core/errors.h"
#include "telemime/image/light_change.h"

namespace telemime {
namespace {

/// Noise floors (standard deviations) for quantisation, compression and flicker: without them a still scene
/// would have no variance.
constexpr float kChromaFloor = 0.018F;
constexpr float kLuminanceFloor = 0.022F;
/// Assumed noise of each channel in grey levels. On the logarithmic scale, dark pixels are noisier.
constexpr float kChannelNoise = 1.5F;

}  // namespace

BackgroundNoise background_noise(float l) {
  const float deviation = kChannelNoise / std::exp(l);
  const float channel = deviation * deviation;  // of the logarithm of a channel
  return {kChromaFloor * kChromaFloor + 2 * channel, kLuminanceFloor * kLuminanceFloor + channel / 3};
}

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
  // Automatic exposure may change while the images are taken.
  const std::optional<BackgroundModel> first =
      images.size() > 1 ? std::optional(learn_background_model(images.first(1))) : std::nullopt;
  for (const cv::Mat& image : images) {
    if (image.size() != size) {
      throw Error(ErrorKind::usage, "the background images differ in size");
    }
    LogColour colour = log_colour(image);
    if (first) {
      compensate(*first, estimate_light(*first, colour, {}), colour);
    }
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
      const BackgroundNoise noise = background_noise(l[c]);
      chroma[c] = std::max(chroma[c], 0.0F) + noise.chroma;
      luminance[c] = std::max(luminance[c], 0.0F) + noise.luminance;
    }
  }
  return model;
}

BackgroundEnergy background_energy(const BackgroundModel& model, const LogColour& image,
                                   const ShadowRange& shadow) {
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
  return out;
}

void set_unknown(const BackgroundModel& model, const cv::Mat& unknown, BackgroundEnergy& energy) {
  const cv::Mat invalid = model.valid == 0;
  unknown.copyTo(energy.energy, invalid);
  energy.shaded.setTo(0, invalid);
}

void adapt_background(BackgroundModel& model, const LogColour& image, const cv::Mat& where, float rate,
                      int steady) {
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
    auto* vc = model.chroma_variance.ptr<float>(r);
    auto* vl = model.luminance_variance.ptr<float>(r);
    for (int c = 0; c < model.valid.cols; ++c) {
      float k = w[c] != 0 ? rate : 0.0F;
      // An invalid pixel averages its colours until it has been steady for long enough.
      if (valid[c] == 0) {
        const float step = std::abs(u[c] - mu[c]) + std::abs(v[c] - mv[c]) + std::abs(l[c] - ml[c]);
        const bool goes_on = seen[c] > 0 && step < 3 * kSteady;
        seen[c] = static_cast<unsigned char>(w[c] == 0 ? 0 : (goes_on ? std::min(seen[c] + 1, 255) : 1));
        k = w[c] == 0 ? 0.0F : 1.0F / static_cast<float>(seen[c]);
        valid[c] = seen[c] >= steady ? 255 : 0;
        if (valid[c] != 0) {
          const BackgroundNoise noise = background_noise(ml[c]);
          vc[c] = noise.chroma;
          vl[c] = noise.luminance;
        }
      }
      mu[c] += k * (u[c] - mu[c]);
      mv[c] += k * (v[c] - mv[c]);
      ml[c] += k * (l[c] - ml[c]);
    }
  }
}

}  // namespace telemime
