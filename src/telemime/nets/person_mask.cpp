// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/person_mask.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "telemime/core/errors.h"
#include "telemime/core/in_parallel.h"
#include "telemime/nets/models/table.h"

namespace telemime {
namespace {

constexpr int kCells = 256;  // of the mask, in each direction

// The windows of the network reach 16 rows of the mask beyond a half: 4 of 64 bands.
constexpr int kBands = 64;
constexpr int kReach = 4;
constexpr RowShare kComputed{.bands = kBands / 2 + kReach, .parts = kBands};
constexpr std::array<int, 2> kFirst = {0, kBands / 2 - kReach};  // of the computed bands of each half

// Runs the network of a half and writes the half's own rows into the cells.
void compute_half(std::size_t half, const MaskInput& input, Network& network, cv::Mat& cells) {
  std::array<std::span<const float>, 2> images;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::size_t size = element_count(network.input_shape(i));
    const std::size_t band = size / kComputed.bands;
    if (input.images[i].size() != band * kBands) {
      throw Error(ErrorKind::usage, "a mask was asked for from the landmarks of another model");
    }
    images[i] = std::span(input.images[i]).subspan(band * static_cast<std::size_t>(kFirst[half]), size);
  }
  const std::span<const float> logits = network.run(images)[0];
  const int first = static_cast<int>(half) * kCells / 2;
  const int above = first - kFirst[half] * kCells / kBands;
  const auto* logit = logits.data() + static_cast<std::ptrdiff_t>(above) * kCells;
  constexpr std::ptrdiff_t kHalf = std::ptrdiff_t{kCells} * kCells / 2;
  std::transform(logit, logit + kHalf, cells.ptr<std::uint8_t>(first), [](float value) {
    const auto probability = static_cast<float>(1.0 / (1.0 + std::exp(-static_cast<double>(value))));
    return cv::saturate_cast<std::uint8_t>(255.0F * probability);
  });
}

}  // namespace

MaskNetworks load_mask_networks(const std::filesystem::path& models, PoseModel model) {
  const PoseModelFile file = pose_model_file(model);
  const NetworkPart part{
      .inputs = {file.mask_inputs[0], file.mask_inputs[1]}, .outputs = {file.mask}, .rows = kComputed};
  return {.halves = {load_network(models, file.name, part), load_network(models, file.name, part)}};
}

cv::Mat person_mask(const MaskInput& input, cv::Size picture, MaskNetworks& networks) {
  const cv::Size grid(kCells, kCells);
  const cv::Range rows = rows_in_picture(input.region, grid, picture);
  cv::Mat cells = cv::Mat::zeros(grid, CV_8UC1);
  const auto compute = [&](std::size_t half) {
    const int first = static_cast<int>(half) * kCells / 2;
    if (rows.start < first + kCells / 2 && rows.end > first) {
      compute_half(half, input, networks.halves[half], cells);
    }
  };
  in_parallel([&] { compute(0); }, [&] { compute(1); });
  return picture_mask(cells, input.region, picture);
}

}  // namespace telemime
