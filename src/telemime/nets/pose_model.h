// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

namespace telemime {

/// The sizes of the network that sees the landmarks and the mask of a person.
enum class PoseModel { lite, full, heavy };

/// The file of such a network, and the names of tensors in it.
struct PoseModelFile {
  std::string name;  ///< of the file: load_network()
  std::string landmarks, score, heat_map, world, mask;
  std::array<std::string, 2> mask_inputs;  ///< the images that the mask shares with the landmarks
};

/// The file of this model.
PoseModelFile pose_model_file(PoseModel model);

}  // namespace telemime
