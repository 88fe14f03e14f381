// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/pose_model.h"

namespace telemime {
namespace {

PoseModelFile file_of(const std::string& size, const std::string& fine, const std::string& coarse) {
  const std::string layers = "model_1/model/";
  return {.name = "pose_landmark_" + size,
          .landmarks = "Identity",
          .score = "Identity_1",
          .heat_map = "Identity_3",
          .world = "Identity_4",
          .mask = "Identity_2",
          .mask_inputs = {layers + "batch_normalization_2/FusedBatchNormV3;" + layers + fine + ";" + layers +
                              "conv2d_1/Conv2D1",
                          layers + coarse}};
}

}  // namespace

PoseModelFile pose_model_file(PoseModel model) {
  switch (model) {
    case PoseModel::lite:
      return file_of("lite", "conv2d_48/Conv2D", "add_11/add");
    case PoseModel::heavy:
      return file_of("heavy", "depthwise_conv2d_76/depthwise", "add_25/add");
    case PoseModel::full:
      return file_of("full", "depthwise_conv2d_32/depthwise", "add_11/add");
  }
  return {};
}

}  // namespace telemime
