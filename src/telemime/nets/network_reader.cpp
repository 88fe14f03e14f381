// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <opencv2/core.hpp>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/nets/flat_table.h"
#include "telemime/nets/network_graph.h"
#include "telemime/nets/network_operators.h"
#include "telemime/nets/network_shapes.h"

namespace telemime {
namespace {

constexpr std::size_t kMostElements = std::size_t{1} << 24U;       // of one tensor
constexpr std::size_t kMostElementsOfAll = std::size_t{1} << 27U;  // of a network

void require(bool fits, const char* what) {
  if (!fits) {
    throw Error(ErrorKind::config, std::string("the network file is damaged: ") + what,
                "Install the models again.");
  }
}

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

std::vector<int> read_integers(std::span<const std::byte> bytes) {
  std::vector<int> values(bytes.size() / sizeof(std::int32_t));
  if (!values.empty()) {
    std::memcpy(values.data(), bytes.data(), sizeof(std::int32_t) * values.size());
  }
  return values;
}

std::vector<int> sparse_indices(const FlatTable& dimension, int type_field) {
  const auto type = dimension.number<std::uint8_t>(type_field);
  const std::optional<FlatTable> vector = dimension.table(type_field + 1);
  require(vector.has_value(), "a sparse array has no indices");
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
  require(dimensions.size() == shape.size() && sparsity.numbers<std::int32_t>(1).empty(),
          "a sparse array is stored in blocks");
  const std::vector<std::int32_t> order = sparsity.numbers<std::int32_t>(0);
  for (std::size_t i = 0; i < dimensions.size(); ++i) {
    const bool sparse = dimensions[i].number<std::int8_t>(0) != 0;
    require(i < order.size() && order[i] == static_cast<int>(i) && sparse == (i + 1 == dimensions.size()),
            "a sparse array is not stored row by row");
  }
  const std::vector<int> rows = sparse_indices(dimensions.back(), 2);
  const std::vector<int> columns = sparse_indices(dimensions.back(), 4);
  const auto width = static_cast<std::size_t>(shape.back());
  std::vector<float> dense(element_count(shape), 0.0F);
  require(rows.size() == dense.size() / width + 1 && columns.size() == values.size(),
          "a sparse array has another number of rows");
  for (std::size_t row = 0; row + 1 < rows.size(); ++row) {
    require(rows[row] >= 0 && rows[row] <= rows[row + 1] &&
                static_cast<std::size_t>(rows[row + 1]) <= values.size(),
            "the rows of a sparse array are in disorder");
    for (int i = rows[row]; i < rows[row + 1]; ++i) {
      require(columns[i] >= 0 && static_cast<std::size_t>(columns[i]) < width,
              "a sparse array has a wide row");
      dense[row * width + columns[i]] = values[i];
    }
  }
  return dense;
}

NetworkTensor read_tensor(const FlatTable& from, const std::vector<FlatTable>& buffers) {
  NetworkTensor tensor;
  tensor.shape = from.numbers<std::int32_t>(0);
  tensor.name = from.text(3);
  std::size_t count = 1;
  for (const int size : tensor.shape) {
    require(size >= 1 && static_cast<std::size_t>(size) <= kMostElements, "an array has no usable size");
    count *= static_cast<std::size_t>(size);
    require(count <= kMostElements, "an array is too large");
  }
  const auto buffer = from.number<std::uint32_t>(2);
  require(buffer < buffers.size(), "an array has no buffer");
  const std::span<const std::byte> bytes = buffers[buffer].bytes(0);
  if (bytes.empty()) {
    return tensor;
  }
  const auto format = static_cast<NumberFormat>(from.number<std::int8_t>(1));
  if (format == NumberFormat::int32) {
    tensor.integers = read_integers(bytes);
    require(tensor.integers.size() == count, "a constant has more or fewer numbers than its shape");
    return tensor;
  }
  require(format == NumberFormat::float32 || format == NumberFormat::float16,
          "weights are neither single nor half precision");
  tensor.values = read_floats(bytes, format);
  if (const std::optional<FlatTable> sparsity = from.table(6); sparsity && !tensor.shape.empty()) {
    tensor.values = densified(*sparsity, tensor.shape, tensor.values);
  }
  require(tensor.values.size() == count, "a constant has more or fewer numbers than its shape");
  return tensor;
}

struct OperatorCode {
  int code = 0;
  std::string custom;
};

std::vector<OperatorCode> read_codes(const FlatTable& model) {
  std::vector<OperatorCode> codes;
  for (const FlatTable& code : model.tables(1)) {
    // Files of older versions have small codes in field 0, newer ones all codes in field 3.
    codes.push_back({std::max<int>(code.number<std::int8_t>(0), code.number<std::int32_t>(3)), code.text(1)});
  }
  return codes;
}

// Follows the operators in their order and checks that each computes one new tensor from known ones.
class GraphBuilder {
 public:
  GraphBuilder(NetworkGraph& graph, std::vector<OperatorCode> codes)
      : graph_(graph),
        codes_(std::move(codes)),
        known_(graph.tensors.size()),
        same_as_(graph.tensors.size()) {
    for (std::size_t i = 0; i < known_.size(); ++i) {
      known_[i] = graph.tensors[i].is_constant();
      same_as_[i] = static_cast<int>(i);
    }
    require(!known_[graph.input], "the input is a constant");
    known_[graph.input] = true;
  }

  void add(const FlatTable& from) {
    FileOperator op = resolve(from);
    require(!known_[op.output], "an array is computed twice");
    known_[op.output] = true;
    if (copies_constant(op)) {
      require(op.inputs.size() == 1 && graph_.tensors[op.inputs[0]].is_constant() &&
                  graph_.tensors[op.inputs[0]].shape == graph_.tensors[op.output].shape,
              "a constant is converted to another shape");
      same_as_[op.output] = op.inputs[0];
      return;
    }
    const std::size_t first = graph_.nodes.size();
    append_nodes(op, graph_);
    for (std::size_t i = first; i < graph_.nodes.size(); ++i) {
      check_shapes(graph_, graph_.nodes[i]);
    }
  }

  void check_outputs() const {
    for (const int output : graph_.outputs) {
      require(known_[output] && !graph_.tensors[same_as_[output]].is_constant() && output != graph_.input,
              "an output is not computed");
    }
  }

 private:
  FileOperator resolve(const FlatTable& from) const {
    const auto code = from.number<std::uint32_t>(0);
    const std::vector<std::int32_t> outputs = from.numbers<std::int32_t>(2);
    require(code < codes_.size() && outputs.size() == 1 && outputs[0] >= 0 &&
                static_cast<std::size_t>(outputs[0]) < known_.size(),
            "an operator has no code or output");
    FileOperator op{.code = codes_[code].code,
                    .custom = codes_[code].custom,
                    .inputs = {},
                    .output = outputs[0],
                    .options = from.table(4),
                    .custom_options = {}};
    for (const std::int32_t input : from.numbers<std::int32_t>(1)) {
      if (input == -1) {
        break;  // an operator's optional inputs are its last ones
      }
      require(input >= 0 && static_cast<std::size_t>(input) < known_.size() && known_[input] &&
                  !graph_.tensors[same_as_[input]].shape.empty(),
              "an operator reads an array before it is computed");
      op.inputs.push_back(same_as_[input]);
    }
    require(!op.inputs.empty(), "an operator has no input");
    if (!op.custom.empty()) {
      op.custom_options = read_integers(from.bytes(5));
    }
    return op;
  }

  NetworkGraph& graph_;
  std::vector<OperatorCode> codes_;
  std::vector<bool> known_;
  std::vector<int> same_as_;
};

std::vector<int> tensor_list(const FlatTable& from, int field, std::size_t count) {
  std::vector<int> list = from.numbers<std::int32_t>(field);
  for (const int index : list) {
    require(index >= 0 && static_cast<std::size_t>(index) < count, "an array does not exist");
  }
  return list;
}

}  // namespace

std::size_t element_count(const TensorShape& shape) {
  std::size_t count = 1;
  for (const int size : shape) {
    count *= static_cast<std::size_t>(size);
  }
  return count;
}

NetworkGraph read_network_graph(std::span<const std::byte> file) {
  const FlatTable model = FlatTable::root(file, "TFL3");
  const std::vector<FlatTable> subgraphs = model.tables(2);
  require(subgraphs.size() == 1, "it has not exactly one graph");
  const std::vector<FlatTable> buffers = model.tables(4);

  NetworkGraph graph;
  std::size_t total = 0;
  for (const FlatTable& tensor : subgraphs[0].tables(0)) {
    graph.tensors.push_back(read_tensor(tensor, buffers));
    total += element_count(graph.tensors.back().shape);
    require(total <= kMostElementsOfAll, "its arrays are too large");
  }
  const std::vector<int> inputs = tensor_list(subgraphs[0], 1, graph.tensors.size());
  require(inputs.size() == 1 && !graph.tensors[inputs[0]].shape.empty(), "it has not exactly one input");
  graph.input = inputs[0];
  graph.outputs = tensor_list(subgraphs[0], 2, graph.tensors.size());

  GraphBuilder builder(graph, read_codes(model));
  for (const FlatTable& from : subgraphs[0].tables(3)) {
    builder.add(from);
  }
  builder.check_outputs();
  return graph;
}

NetworkGraph keep_outputs(NetworkGraph graph, std::span<const std::string> names) {
  std::vector<int> outputs;
  for (const std::string& name : names) {
    const auto found = std::find_if(graph.outputs.begin(), graph.outputs.end(),
                                    [&](int output) { return graph.tensors[output].name == name; });
    if (found == graph.outputs.end()) {
      throw Error(ErrorKind::config, "the network has no output " + name, "Install the models again.");
    }
    outputs.push_back(*found);
  }
  graph.outputs = std::move(outputs);

  // Backwards: a node is needed if a later one reads what it computes.
  std::vector<bool> needed(graph.tensors.size(), false);
  needed[graph.input] = true;
  for (const int output : graph.outputs) {
    needed[output] = true;
  }
  std::vector<NetworkNode> nodes;
  for (auto node = graph.nodes.rbegin(); node != graph.nodes.rend(); ++node) {
    if (needed[node->output]) {
      for (const int input : node->inputs) {
        needed[input] = true;
      }
      nodes.push_back(std::move(*node));
    }
  }
  std::reverse(nodes.begin(), nodes.end());
  graph.nodes = std::move(nodes);
  for (std::size_t i = 0; i < graph.tensors.size(); ++i) {
    if (!needed[i]) {
      graph.tensors[i].values = {};
      graph.tensors[i].integers = {};
    }
  }
  return graph;
}

}  // namespace telemime
