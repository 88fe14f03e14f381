// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "lab/synth/sequence.h"
#include "telemime/image/person_finder.h"
#include "telemime/likelihood/body_landmarks.h"

namespace telemime {

/// Where the truth has a landmark: at origin + axes * LandmarkPoint::offset, m, camera frame.
struct LandmarkPlace {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  bool known = true;  ///< false: the truth does not determine the axes
};
using LandmarkPlaces = std::array<LandmarkPlace, kLandmarkCount>;

/// The places of a synthetic person: joints and axes as the model defines them, the unit of each segment by
/// the length of its bone against that of an average body.
LandmarkPlaces actor_places(const ActorKinematics& kinematics);

/// What the networks see in one frame, and the truth.
struct LearningFrame {
  Camera camera;  ///< of the picture in which the landmarks are
  BodyLandmarks seen;
  LandmarkPlaces places;
};

/// Renders every `step`-th frame of a scene, without files, and runs the networks: the frames in which a
/// person is found.
std::vector<LearningFrame> learning_frames(const Scene& scene, int step, PersonFinder& finder);

/// The numbers of kLandmarkPoints and kLandmarkBoneSigma, learned. Both sides of the body have the same. The
/// standard deviations of bones are about kLandmarkBoneResponse, which is not learned.
struct LearnedLandmarks {
  struct Point {
    std::array<double, 3> offset{};
    std::array<double, 3> error{};  ///< standard error of the offset if the frames' errors are independent
    double sigma = 0.0;
    std::size_t count = 0;  ///< of observations
  };
  std::array<Point, kLandmarkCount> points;
  std::array<double, kLandmarkBoneCount> bone_sigma{};
};

/// Offsets: least squares of the errors in the picture under Huber's weights (Huber & Ronchetti, Robust
/// Statistics, 2009), which bound what an outlier does. Deviations: by the median of the errors. An offset of
/// which fewer than ten observations tell stays as it is.
LearnedLandmarks learn_landmarks(std::span<const LearningFrame> frames);

}  // namespace telemime
