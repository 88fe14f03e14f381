// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <flatbuffers/flatbuffers.h>

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

/// Small TensorFlow Lite files for tests, written with the library FlatBuffers.
namespace telemime::testing_network_file {

/// A scalar field of a table.
struct Option {
  int field = 0;
  int value = 0;
  bool wide = false;  ///< 32 bits instead of 8
};

struct FileTensor {
  std::vector<int> shape;
  std::vector<float> values = {};  ///< of a constant
  std::vector<int> integers = {};  ///< of a constant
  bool half = false;
  std::vector<int> row_starts = {};        ///< of a sparse constant
  std::vector<std::uint8_t> columns = {};  ///< of a sparse constant
};

struct FileNode {
  int code = 0;  ///< BuiltinOperator of the schema
  std::vector<int> inputs;
  int output = 0;
  std::vector<Option> options = {};
};

using Builder = flatbuffers::FlatBufferBuilder;
using Offset = flatbuffers::uoffset_t;

inline flatbuffers::voffset_t slot(int field) {
  return static_cast<flatbuffers::voffset_t>(4 + 2 * field);
}

/// A table with scalars and references to parts that were written before: (field, offset).
inline Offset table(Builder& to, const std::vector<Option>& scalars,
                    const std::vector<std::pair<int, Offset>>& parts) {
  const Offset start = to.StartTable();
  for (const auto& [field, offset] : parts) {
    to.AddOffset(slot(field), flatbuffers::Offset<void>(offset));
  }
  for (const Option& option : scalars) {
    if (option.wide) {
      to.AddElement<std::int32_t>(slot(option.field), option.value, 0);
    } else {
      to.AddElement<std::int8_t>(slot(option.field), static_cast<std::int8_t>(option.value), 0);
    }
  }
  return to.EndTable(start);
}

inline Offset list(Builder& to, const std::vector<Offset>& tables) {
  std::vector<flatbuffers::Offset<void>> offsets;
  for (const Offset each : tables) {
    offsets.emplace_back(each);
  }
  return to.CreateVector(offsets).o;
}

inline std::vector<std::uint8_t> bytes_of(const FileTensor& tensor) {
  const auto copied = [](const auto& values) {
    const auto* const first = reinterpret_cast<const std::uint8_t*>(values.data());
    return std::vector<std::uint8_t>(first, first + values.size() * sizeof(values[0]));
  };
  if (!tensor.half) {
    return tensor.integers.empty() ? copied(tensor.values) : copied(tensor.integers);
  }
  std::vector<cv::float16_t> halves(tensor.values.begin(), tensor.values.end());
  return copied(halves);
}

inline Offset sparsity(Builder& to, const FileTensor& tensor) {
  std::vector<Offset> dimensions;
  std::vector<int> order;
  for (std::size_t i = 0; i + 1 < tensor.shape.size(); ++i) {
    dimensions.push_back(table(to, {{1, tensor.shape[i], true}}, {}));
    order.push_back(static_cast<int>(i));
  }
  order.push_back(static_cast<int>(dimensions.size()));
  const Offset starts = table(to, {}, {{0, to.CreateVector(tensor.row_starts).o}});
  const Offset columns = table(to, {}, {{0, to.CreateVector(tensor.columns).o}});
  dimensions.push_back(table(to, {{0, 1}, {2, 1}, {4, 3}}, {{3, starts}, {5, columns}}));
  return table(to, {}, {{0, to.CreateVector(order).o}, {2, list(to, dimensions)}});
}

/// The file of a network whose first tensor is its input; tensors are named "t0", "t1", ...
inline std::vector<std::byte> network_file(const std::vector<FileTensor>& tensors,
                                           const std::vector<FileNode>& nodes,
                                           const std::vector<int>& outputs) {
  Builder to;
  to.ForceDefaults(true);
  std::vector<Offset> buffers = {table(to, {}, {})};
  std::vector<Offset> arrays;
  for (const FileTensor& tensor : tensors) {
    int buffer = 0;
    if (!tensor.values.empty() || !tensor.integers.empty()) {
      buffer = static_cast<int>(buffers.size());
      buffers.push_back(table(to, {}, {{0, to.CreateVector(bytes_of(tensor)).o}}));
    }
    std::vector<std::pair<int, Offset>> parts = {{0, to.CreateVector(tensor.shape).o},
                                                 {3, to.CreateString("t" + std::to_string(arrays.size())).o}};
    if (!tensor.row_starts.empty()) {
      parts.emplace_back(6, sparsity(to, tensor));
    }
    const int type = tensor.half ? 1 : (tensor.integers.empty() ? 0 : 2);
    arrays.push_back(table(to, {{1, type}, {2, buffer, true}}, parts));
  }
  std::vector<Offset> codes;
  std::vector<Offset> operators;
  for (const FileNode& node : nodes) {
    const Offset options = table(to, node.options, {});
    operators.push_back(table(to, {{0, static_cast<int>(codes.size()), true}, {3, 1}},
                              {{1, to.CreateVector(node.inputs).o},
                               {2, to.CreateVector(std::vector<int>{node.output}).o},
                               {4, options}}));
    codes.push_back(table(to, {{3, node.code, true}}, {}));
  }
  const Offset graph = table(to, {},
                             {{0, list(to, arrays)},
                              {1, to.CreateVector(std::vector<int>{0}).o},
                              {2, to.CreateVector(outputs).o},
                              {3, list(to, operators)}});
  const Offset model =
      table(to, {{0, 3, true}}, {{1, list(to, codes)}, {2, list(to, {graph})}, {4, list(to, buffers)}});
  to.Finish(flatbuffers::Offset<void>(model), "TFL3");
  const auto* const first = reinterpret_cast<const std::byte*>(to.GetBufferPointer());
  return {first, first + to.GetSize()};
}

}  // namespace telemime::testing_network_file
