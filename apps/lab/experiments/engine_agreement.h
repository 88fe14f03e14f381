// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "lab/experiments/engine_bench.h"
#include "telemime/body/limits.h"
#include "telemime/core/random.h"

namespace telemime {

/// Poses with every angle uniform within the limits, 1.0 to 1.6 m from the camera; poses with an arm inside
/// the body (kInvalidInterpenetration) are redrawn. Throws Error(usage) when the limits allow hardly any
/// other.
std::vector<Pose> valid_poses(const Body& body, const JointLimits& limits, std::size_t count, Random& random);

/// Three people: the default, a taller one with other proportions, a smaller one with longer sleeves.
std::array<Shape, 3> different_people();

/// Rank correlation of two equally long lists (C. Spearman, Am. J. Psychology 15, 1904), in [-1, 1]: the
/// correlation of their ranks, equal values taking the mean of theirs. 0 when all values of a list are equal.
/// Throws Error(usage) for other lengths.
double spearman(std::span<const double> a, std::span<const double> b);

/// Differences of two back ends' scores.
struct Agreement {
  std::size_t poses = 0;
  double region_max = 0.0, region_mean = 0.0;    ///< |dF|
  double contour_max = 0.0, contour_mean = 0.0;  ///< |dD_C|, px
};

/// `tested` against `reference` at 160x120 over `poses` random valid poses of the three people, each against
/// pictures of other poses.
Agreement compare_scores(Backend& reference, Backend& tested, std::size_t poses, std::uint64_t seed);

/// How two back ends rank poses near the true one: rank correlations over frames.
struct RankAgreement {
  double region_min = 1.0, region_mean = 0.0;
  double contour_min = 1.0, contour_mean = 0.0;
};

/// `frames` pictures of random valid poses; 200 poses about each, a few degrees and centimetres away.
RankAgreement compare_ranks(Backend& reference, Backend& tested, std::size_t frames, std::uint64_t seed);

/// Every back end of the options but `scalar` against it.
Table agreement_table(const EngineOptions& options);
Table ranking_table(const EngineOptions& options);

}  // namespace telemime
