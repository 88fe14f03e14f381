// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/colour_model.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"

namespace telemime {
namespace {

using Samples = std::vector<Eigen::Vector3f>;

void add(Samples& samples, const Eigen::Vector3f& mean, float spread, int count, Random& random) {
  for (int i = 0; i < count; ++i) {
    samples.emplace_back(mean + spread * Eigen::Vector3f(static_cast<float>(random.normal()),
                                                         static_cast<float>(random.normal()),
                                                         static_cast<float>(random.normal())));
  }
}

// Energy of one colour [u, v, l].
float energy_of(const ColourMixture& mixture, const Eigen::Vector3f& colour) {
  const auto pixel = [](float value) { return cv::Mat(1, 1, CV_32FC1, cv::Scalar(value)); };
  return energy(mixture, {pixel(colour[0]), pixel(colour[1]), pixel(colour[2])}).at<float>(0, 0);
}

TEST(LogColour, ShadowChangesOnlyLuminance) {
  // Doubling the light on colours far above the offset changes only l, by ln 2.
  const Eigen::Vector3f dark = log_colour_of(100, 110, 120);
  const Eigen::Vector3f light = log_colour_of(2 * 100 + 12, 2 * 110 + 12, 2 * 120 + 12);
  EXPECT_NEAR(dark[0], light[0], 1e-4);
  EXPECT_NEAR(dark[1], light[1], 1e-4);
  EXPECT_NEAR(light[2] - dark[2], std::log(2.0), 1e-4);
}

TEST(LogColour, ImagesAndSinglePixelsAgree) {
  const cv::Mat bgr(2, 3, CV_8UC3, cv::Scalar(10, 200, 90));
  const LogColour image = log_colour(bgr);
  const Eigen::Vector3f one = log_colour_of(10, 200, 90);
  EXPECT_FLOAT_EQ(image.u.at<float>(1, 2), one[0]);
  EXPECT_FLOAT_EQ(image.v.at<float>(1, 2), one[1]);
  EXPECT_NEAR(image.l.at<float>(1, 2), one[2], 1e-6);
  EXPECT_THROW(log_colour(cv::Mat(2, 2, CV_8UC1)), Error);
}

TEST(ColourModel, RobustMeanIgnoresAThirdOfOutliers) {
  Random random(1);
  Samples samples;
  const Eigen::Vector3f skin(0.25F, -0.15F, 5.0F);
  add(samples, skin, 0.04F, 400, random);
  add(samples, {0.0F, 0.0F, 3.0F}, 0.1F, 200, random);
  const ColourGaussian fitted = fit_robust(samples, {});
  EXPECT_LT((fitted.mean - skin).norm(), 0.02F);
  EXPECT_LT(mahalanobis2({fitted}, skin), 1.0F);
  EXPECT_GT(mahalanobis2({fitted}, {0.0F, 0.0F, 3.0F}), 20.0F);
}

TEST(ColourModel, CovarianceIsPositiveForCollinearSamples) {
  Samples samples;
  for (int i = 0; i < 100; ++i) {
    const float t = static_cast<float>(i) / 50.0F;
    samples.emplace_back(3 * t, -2 * t, t);
  }
  const ColourGaussian fitted = fit_robust(samples, {});
  EXPECT_GT(fitted.covariance.determinant(), 0.0F);
  EXPECT_GT((fitted.covariance.topLeftCorner<2, 2>().determinant()), 0.0F);
}

TEST(ColourModel, StripesGetOneGaussianEach) {
  Random random(2);
  Samples samples;
  const std::vector<Eigen::Vector3f> stripes{{0, 0, 5.4F}, {1.2F, -0.1F, 4.4F}, {-0.45F, 0.5F, 4.4F}};
  for (const auto& s : stripes) {
    add(samples, s, 0.03F, 200, random);
  }
  const ColourMixture mixture = fit_mixture(samples, 5, {});
  EXPECT_LE(mixture.size(), 4U);
  for (const auto& s : stripes) {
    EXPECT_LT(mahalanobis2(mixture, s), 1.0F);
  }
  EXPECT_EQ(fit_mixture(samples, 1, {}).size(), 1U);
}

TEST(ColourModel, PlainColourGetsOneGaussian) {
  Random random(3);
  Samples samples;
  add(samples, {0.1F, 0.1F, 4.0F}, 0.02F, 300, random);
  EXPECT_EQ(fit_mixture(samples, 5, {}).size(), 1U);
}

TEST(ColourModel, EnergyIsMinusTwoLogDensity) {
  ColourGaussian g;
  g.mean = {0.2F, -0.1F, 4.5F};
  g.covariance = Eigen::Vector3f(0.01F, 0.02F, 0.09F).asDiagonal();
  g.weight = 0.5F;
  const float expected = std::log(0.01F * 0.02F * 0.09F) - 2 * std::log(0.5F);
  EXPECT_NEAR(energy_of({g}, g.mean), expected, 1e-3);
  EXPECT_NEAR(energy_of({g}, g.mean + Eigen::Vector3f(0.1F, 0, 0)), expected + 1, 1e-3);
  const LogColour image = log_colour(cv::Mat(3, 4, CV_8UC3, cv::Scalar(40, 60, 90)));
  EXPECT_NEAR(energy({g}, image).at<float>(1, 1), energy_of({g}, log_colour_of(40, 60, 90)), 1e-2);
  EXPECT_GT(energy(ColourMixture{}, image).at<float>(0, 0), 1000.0F);
}

TEST(ColourModel, RefusesTooFewSamples) {
  const Samples few(5, Eigen::Vector3f::Zero());
  EXPECT_THROW(fit_robust(few, {}), Error);
  EXPECT_THROW(fit_mixture(few, 3, {}), Error);
}

}  // namespace
}  // namespace telemime
