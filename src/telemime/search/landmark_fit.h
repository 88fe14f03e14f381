// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "telemime/body/limits.h"
#include "telemime/likelihood/body_landmarks.h"

namespace telemime {

/// What is known about a pose before the landmarks are looked at.
struct LandmarkPrior {
  Pose pose;               ///< the likeliest pose
  double following = 0.0;  ///< above 0: standard deviation (m) of elbows and wrists about those of `pose`
};

/// A pose that was fitted to landmarks.
struct LandmarkFit {
  Pose pose;
  double cost = 0.0;  ///< half the sum of squared errors in standard deviations, prior included
};

/// The pose nearest to the landmarks: Levenberg-Marquardt over all 23 numbers from `start`, robust against
/// outliers, inside the limits.
LandmarkFit fit_to_landmarks(const Body& body, const Camera& camera, const BodyLandmarks& landmarks,
                             const LandmarkPrior& prior, const Pose& start, const JointLimits& limits);

/// A person of this body in the pose that the landmarks and the slopes of the bones suggest, without any
/// earlier frame. Empty when neither both shoulders, nor both eyes, nor both ears are seen.
std::optional<Pose> pose_from_landmarks(const Body& body, const Camera& camera,
                                        const BodyLandmarks& landmarks, const JointLimits& limits);

/// Poses that explain the landmarks equally well: the fit from `prior` and its mirror images in depth, each
/// fitted again; cheapest first, none twice, at most `most`.
std::vector<LandmarkFit> landmark_proposals(const Body& body, const Camera& camera,
                                            const BodyLandmarks& landmarks, const LandmarkPrior& prior,
                                            const JointLimits& limits, std::size_t most);

}  // namespace telemime
