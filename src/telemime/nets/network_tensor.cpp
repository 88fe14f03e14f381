// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/network_operators.h"

#include <cstring>
#include <opencv2/core.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr std::size_t kMostElements = std::size_t{1} << 24U;  // of one array

enum class NumberFormat : std::int8_t { float32 = 0, float16 = 1, int32 = 2 };

std::vector<float> read_floats(std::span<const std::byte> bytes, NumberFormat format) {
  const bool half = format == NumberFormat::float16;
  std::vector<float> values(bytes.size() / (half ? 2 : sizeof(float)));
  if (half && !values.empty()) {
    std::vector<std::uint16_t> halves(values.size());
    std::memcpy(halves.data(), bytes.data(), 2 * halves.size());
    const cv::Mat from(1, static_cast<int>(halves.size()), CV_16FC1, halves.data());
    cv::Mat to(1, static_cast<int>(values.size()), CV_32FC1, values.data());
    from.convertTo(to, CV_32F);
  } else if (!values.empty()) {
    std::memcpy(values.data(), bytes.data(), sizeof(float) * values.size());
  }
  return values;
}

std::vector<int> sparse_indices(const FlatTable& dimension, int type_field) {
  const auto type = dimension.number<std::uint8_t>(type_field);
  const std::optional<FlatTable> vector = dimension.table(type_field + 1);
  require_intact(vector.has_value(), "a sparse array has no indices");
  const auto widened = [](const auto& values) { return std::vector<int>(values.begin(), values.end()); };
  switch (type) {
    case 1:
      return vector->numbers<std::int32_t>(0);
    case 2:
      return widened(vector->numbers<std::uint16_t>(0));
    default:
      return widened(vector->numbers<std::uint8_t>(0));
  }
}

// Weights of which each row lists only the columns that are not zero (compressed sparse rows).
std::vector<float> densified(const FlatTable& sparsity, const TensorShape& shape,
                             const std::vector<float>& values) {
  const std::vector<FlatTable> dimensions = sparsity.tables(2);
  require_intact(dimensions.size() == shape.size() && sparsity.numbers<std::int32_t>(1).empty(),
                 "a sparse array is stored in blocks");
  const std::vector<std::int32_t> order = sparsity.numbers<std::int32_t>(0);
  for (std::size_t i = 0; i < dimensions.size(); ++i) {
    const bool sparse = dimensions[i].number<std::int8_t>(0) != 0;
    require_intact(
        i < order.size() && order[i] == static_cast<int>(i) && sparse == (i + 1 == dimensions.size()),
        "a sparse array is not stored row by row");
  }
  const std::vector<int> rows = sparse_indices(dimensions.back(), 2);
  const std::vector<int> columns = sparse_indices(dimensions.back(), 4);
  const auto width = static_cast<std::size_t>(shape.back());
  std::vector<float> dense(element_count(shape), 0.0F);
  require_intact(rows.size() == dense.size() / width + 1 && columns.size() == values.size(),
                 "a sparse array has another number of rows");
  for (std::size_t row = 0; row + 1 < rows.size(); ++row) {
    require_intact(rows[row] >= 0 && rows[row] <= rows[row + 1] &&
                       static_cast<std::size_t>(rows[row + 1]) <= values.size(),
                   "the rows of a sparse array are in disorder");
    for (int i = rows[row]; i < rows[row + 1]; ++i) {
      require_intact(columns[i] >= 0 && static_cast<std::size_t>(columns[i]) < width,
                     "a sparse array has a wide row");
      dense[row * width + columns[i]] = values[i];
    }
  }
  return dense;
}

std::vector<int> read_integers(std::span<const std::byte> bytes) {
  std::vector<int> values(bytes.size() / sizeof(std::int32_t));
  if (!values.empty()) {
    std::memcpy(values.data(), bytes.data(), sizeof(std::int32_t) * values.size());
  }
  return values;
}

}  // namespace

void require_intact(bool fits, const char* what) {
  if (!fits) {
    throw Error(ErrorKind::config, std::string("the network file is damaged: ") + what,
                "Install the models again.");
  }
}

std::size_t element_count(const TensorShape& shape) {
  std::size_t count = 1;
  for (const int size : shape) {
    count *= static_cast<std::size_t>(size);
  }
  return count;
}

NetworkTensor read_tensor(const FlatTable& from, const std::vector<FlatTable>& buffers) {
  NetworkTensor tensor;
  tensor.shape = from.numbers<std::int32_t>(0);
  tensor.name = from.text(3);
  std::size_t count = 1;
  for (const int size : tensor.shape) {
    require_intact(size >= 1 && static_cast<std::size_t>(size) <= kMostElements,
                   "an array has no usable size");
    count *= static_cast<std::size_t>(size);
    require_intact(count <= kMostElements, "an array is too large");
  }
  const auto buffer = from.number<std::uint32_t>(2);
  require_intact(buffer < buffers.size(), "an array has no buffer");
  const std::span<const std::byte> bytes = buffers[buffer].bytes(0);
  if (bytes.empty()) {
    return tensor;
  }
  const auto format = static_cast<NumberFormat>(from.number<std::int8_t>(1));
  if (format == NumberFormat::int32) {
    tensor.integers = read_integers(bytes);
    require_intact(tensor.integers.size() == count, "a constant has more or fewer numbers than its shape");
    return tensor;
  }
  require_intact(format == NumberFormat::float32 || format == NumberFormat::float16,
                 "weights are neither single nor half precision");
  tensor.values = read_floats(bytes, format);
  if (const std::optional<FlatTable> sparsity = from.table(6); sparsity && !tensor.shape.empty()) {
    tensor.values = densified(*sparsity, tensor.shape, tensor.values);
  }
  require_intact(tensor.values.size() == count, "a constant has more or fewer numbers than its shape");
  return tensor;
}

}  // namespace telemime
