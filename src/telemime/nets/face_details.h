// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "telemime/nets/network.h"

namespace telemime {

/// A part of a face (the lips or an eye) that the network of the mesh looks at more closely: it takes a piece
/// of its own image of features around the part. Points are numbered as in FaceLandmarks.
struct FaceDetail {
  Network network;                        ///< from the piece of features to points in it
  std::span<const std::uint16_t> points;  ///< of the mesh, which are refined
  int iris = -1;                          ///< the first of the five points of an iris; -1: the part has none
  int from = 0, to = 0;                   ///< the line between these points is level in the piece
};

/// The lips, the right eye and the left eye of face_landmark_with_attention. Throws Error(config) as
/// load_network does.
std::vector<FaceDetail> load_face_details(const std::filesystem::path& models);

/// Moves the points of a part, and sets those of its iris. `points` are in units of the network's input,
/// whose side is `side`; `features` is the network's image of features of [cells, cells, channels].
void refine(FaceDetail& detail, std::span<const float> features, double side,
            std::span<Eigen::Vector2d> points);

}  // namespace telemime
