// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "telemime/nets/network.h"
#include "telemime/nets/picture_region.h"
#include "telemime/nets/pose_model.h"

namespace telemime {

/// What the network of the landmarks hands on to that of the mask.
struct MaskInput {
  PictureRegion region;                      ///< in which the person was seen
  std::array<std::vector<float>, 2> images;  ///< each [height, width, channels], row-major, as in the file
};

/// The part of a pose network that computes the mask, for the upper and the lower half of its region.
struct MaskNetworks {
  std::array<Network, 2> halves;
};

/// Reads the networks from the folder of the models (find_models()). Throws Error(config) if they are
/// missing.
MaskNetworks load_mask_networks(const std::filesystem::path& models, PoseModel model);

/// The probability that a pixel of a picture of this size shows the person: CV_8UC1, 255 is 1. Only those
/// halves of the region are computed of which the picture shows something, two at a time on the threads of
/// the caller's arena: of a person at a desk, the lower half lies below the picture. Throws Error(usage) if
/// the input comes from another model than the networks.
cv::Mat person_mask(const MaskInput& input, cv::Size picture, MaskNetworks& networks);

}  // namespace telemime
