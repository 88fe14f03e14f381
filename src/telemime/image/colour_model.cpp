// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/colour_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

/// Energy under an empty mixture.
constexpr float kNever = 1e4F;
constexpr float kLeastWeight = 1e-3F;      // of a Gaussian: its logarithm stays finite
constexpr float kLeastVariance = 1e-6F;    // of l: the slope of an even colour stays finite
constexpr std::size_t kFewestColours = 8;  // samples of a Gaussian of three colours
constexpr float kFromMedian = 1.48F;       // standard deviation over the median absolute deviation
constexpr float kLeastSpread = 0.02F;      // of each channel at the start: more than rounding
constexpr int kTrims = 4;                  // rounds of trimming
constexpr float kTrimmed = 8.0F;       // squared deviations: 95 % of a Gaussian of three channels is nearer
constexpr float kOfTails = 1.2F;       // covariance over that of what is nearer
constexpr float kColourNoise = 1e-4F;  // added variance of each channel: an even colour has noise, too
// Groups of k-means: another begins where samples are this far from all others; 95 of 100 distances are
// smaller, for the farthest sample is an outlier.
constexpr float kGroupsApart = 0.15F;
constexpr std::size_t kPercentile = 95;
constexpr int kGroupRounds = 6;             // of k-means for each number of groups
constexpr std::size_t kSmallestGroup = 25;  // a group has at least one in this many samples

Eigen::Vector3f median_of(std::span<const Eigen::Vector3f> samples) {
  Eigen::Vector3f result;
  std::vector<float> values(samples.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(samples.begin(), samples.end(), values.begin(), [axis](const auto& s) { return s[axis]; });
    result[axis] = median(values);
  }
  return result;
}

/// Widens a covariance by the tolerance. The chroma keeps its slope along l.
Eigen::Matrix3f widened(const Eigen::Matrix3f& covariance, const ColourTolerance& tolerance) {
  // A larger spread means that the samples are of two colours (a face with its beard).
  constexpr float kMostVariance = 0.3F * 0.3F;
  const float variance_l = covariance(2, 2) + kLeastVariance;
  const Eigen::Vector2f with_l = covariance.block<2, 1>(0, 2);
  const Eigen::Vector2f slope = (with_l / variance_l).cwiseMax(-tolerance.slope).cwiseMin(tolerance.slope);
  // The covariance of the chroma without slope * l; positive definite for any slope.
  const Eigen::Matrix2f rest = covariance.block<2, 2>(0, 0) - slope * with_l.transpose() -
                               with_l * slope.transpose() + slope * slope.transpose() * variance_l +
                               Eigen::Matrix2f::Identity() * tolerance.chroma * tolerance.chroma;
  const float wanted_l = std::min(variance_l, kMostVariance) * tolerance.stretch * tolerance.stretch +
                         tolerance.luminance * tolerance.luminance;
  Eigen::Matrix3f out;
  out.block<2, 2>(0, 0) = rest + slope * slope.transpose() * wanted_l;
  out.block<2, 1>(0, 2) = slope * wanted_l;
  out.block<1, 2>(2, 0) = out.block<2, 1>(0, 2).transpose();
  out(2, 2) = wanted_l;
  return out;
}

struct Moments {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();
};

Moments moments_of(std::span<const Eigen::Vector3f> samples) {
  Moments m;
  for (const auto& s : samples) {
    m.mean += s;
  }
  m.mean /= static_cast<float>(samples.size());
  for (const auto& s : samples) {
    m.covariance += (s - m.mean) * (s - m.mean).transpose();
  }
  m.covariance /= static_cast<float>(samples.size());
  return m;
}

void require_samples(std::size_t count) {
  if (count < kFewestColours) {
    throw Error(ErrorKind::usage,
                "a colour model needs at least 8 sample pixels, but there are " + std::to_string(count));
  }
}

/// Chroma counts twice in the distances of k-means: stripes differ in hue more than in luminance.
const Eigen::Vector3f kMeansScale(2.0F, 2.0F, 1.0F);

}  // namespace

ColourGaussian fit_robust(std::span<const Eigen::Vector3f> samples, const ColourTolerance& tolerance) {
  require_samples(samples.size());
  // Start from the median and the median absolute deviation.
  Eigen::Vector3f centre = median_of(samples);
  std::vector<Eigen::Vector3f> deviations(samples.size());
  std::transform(samples.begin(), samples.end(), deviations.begin(),
                 [&](const auto& s) { return Eigen::Vector3f((s - centre).cwiseAbs()); });
  const Eigen::Vector3f spread = (kFromMedian * median_of(deviations)).cwiseMax(kLeastSpread);
  Eigen::Matrix3f covariance = spread.cwiseAbs2().asDiagonal();
  // Fit to the samples near the centre, repeatedly.
  for (int i = 0; i < kTrims; ++i) {
    const Eigen::Matrix3f inverse = covariance.inverse();
    std::vector<Eigen::Vector3f> kept;
    for (const auto& s : samples) {
      if ((s - centre).dot(inverse * (s - centre)) < kTrimmed) {
        kept.push_back(s);
      }
    }
    if (kept.size() < kFewestColours) {
      break;
    }
    const Moments m = moments_of(kept);
    centre = m.mean;
    covariance = kOfTails * m.covariance + kColourNoise * Eigen::Matrix3f::Identity();
  }
  return {centre, widened(covariance, tolerance), 1.0F};
}

ColourMixture fit_mixture(std::span<const Eigen::Vector3f> samples, int most,
                          const ColourTolerance& tolerance) {
  require_samples(samples.size());
  std::vector<Eigen::Vector3f> centres{median_of(samples)};
  const auto distance2 = [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    return (a - b).cwiseProduct(kMeansScale).squaredNorm();
  };
  const auto nearest = [&](const Eigen::Vector3f& s) {
    return static_cast<std::size_t>(
        std::min_element(centres.begin(), centres.end(),
                         [&](const auto& a, const auto& b) { return distance2(s, a) < distance2(s, b); }) -
        centres.begin());
  };
  std::vector<std::vector<Eigen::Vector3f>> groups;
  const auto regroup = [&] {
    groups.assign(centres.size(), {});
    for (const auto& s : samples) {
      groups[nearest(s)].push_back(s);
    }
  };
  // Add centres where samples are far from all others.
  while (static_cast<int>(centres.size()) < most) {
    std::vector<std::pair<float, std::size_t>> far;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      far.emplace_back(distance2(samples[i], centres[nearest(samples[i])]), i);
    }
    const auto rank = far.begin() + static_cast<std::ptrdiff_t>(far.size() * kPercentile / 100);
    std::nth_element(far.begin(), rank, far.end());
    if (rank->first < kGroupsApart * kGroupsApart) {
      break;
    }
    centres.push_back(samples[rank->second]);
    for (int i = 0; i < kGroupRounds; ++i) {
      regroup();
      for (std::size_t g = 0; g < groups.size(); ++g) {
        if (!groups[g].empty()) {
          centres[g] = moments_of(groups[g]).mean;
        }
      }
    }
  }
  // A Gaussian for each group.
  regroup();
  ColourMixture mixture;
  for (const auto& group : groups) {
    if (group.size() < kFewestColours || group.size() * kSmallestGroup < samples.size()) {
      continue;
    }
    // Trimming removes the mixed pixels between two stripes.
    ColourGaussian g = fit_robust(group, tolerance);
    g.weight = static_cast<float>(group.size()) / static_cast<float>(samples.size());
    mixture.push_back(g);
  }
  return mixture;
}

cv::Mat energy(const ColourMixture& mixture, const LogColour& image) {
  cv::Mat out(image.u.size(), CV_32FC1, cv::Scalar(kNever));
  for (const ColourGaussian& g : mixture) {
    const Eigen::Matrix3f inverse = g.covariance.inverse();
    const float constant =
        std::log(g.covariance.determinant()) - 2 * std::log(std::max(g.weight, kLeastWeight));
    const float mu = g.mean[0];
    const float mv = g.mean[1];
    const float ml = g.mean[2];
    const float uu = inverse(0, 0);
    const float vv = inverse(1, 1);
    const float ll = inverse(2, 2);
    const float uv = 2 * inverse(0, 1);
    const float ul = 2 * inverse(0, 2);
    const float vl = 2 * inverse(1, 2);
    for (int r = 0; r < out.rows; ++r) {
      const auto* u = image.u.ptr<float>(r);
      const auto* v = image.v.ptr<float>(r);
      const auto* l = image.l.ptr<float>(r);
      auto* o = out.ptr<float>(r);
      for (int c = 0; c < out.cols; ++c) {
        const float du = u[c] - mu;
        const float dv = v[c] - mv;
        const float dl = l[c] - ml;
        const float e =
            du * (uu * du + uv * dv + ul * dl) + dv * (vv * dv + vl * dl) + ll * dl * dl + constant;
        o[c] = e < o[c] ? e : o[c];
      }
    }
  }
  return out;
}

float mahalanobis2(const ColourMixture& mixture, const Eigen::Vector3f& colour) {
  float best = std::numeric_limits<float>::max();
  for (const ColourGaussian& g : mixture) {
    const Eigen::Vector3f d = colour - g.mean;
    best = std::min(best, d.dot(g.covariance.inverse() * d));
  }
  return best;
}

}  // namespace telemime
