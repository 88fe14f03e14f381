// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/person_mask.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "telemime/nets/models/table.h"
#include "telemime/nets/picture_region.h"

namespace telemime {

Network load_person_segmenter(const std::filesystem::path& models, MaskModel model) {
  return load_network(
      models, model == MaskModel::landscape ? "selfie_segmentation_landscape" : "selfie_segmentation");
}

cv::Mat find_person_mask(const cv::Mat& picture, Network& segmenter) {
  const TensorShape& shape = segmenter.input_shape();
  const InputFormat format{.size = {shape[2], shape[1]}};
  const auto outputs = segmenter.run(network_input(picture, whole_picture(picture), format));
  cv::Mat mask(format.size, CV_8UC1);
  std::transform(outputs[0].begin(), outputs[0].end(), mask.begin<std::uint8_t>(),
                 [](float cell) { return cv::saturate_cast<std::uint8_t>(255.0F * cell); });
  cv::Mat result;
  cv::resize(mask, result, picture.size(), 0.0, 0.0, cv::INTER_LINEAR);
  return result;
}

}  // namespace telemime
