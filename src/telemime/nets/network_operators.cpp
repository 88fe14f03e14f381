// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/network_operators.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

// The numbers of operators, options and their fields are those of TensorFlow Lite's schema, version 3.
constexpr int kDequantize = 6;
constexpr int kCustom = 32;
constexpr int kDensify = 124;

[[noreturn]] void unsupported(const std::string& what) {
  throw Error(ErrorKind::config, "the network file cannot be used: " + what + " is not supported",
              "Use the models that Telemime was built with.");
}

void require_supported(bool fits, const std::string& what) {
  if (!fits) {
    unsupported(what);
  }
}

template <class Number>
Number option(const FileOperator& from, int field, Number otherwise = {}) {
  return from.options ? from.options->number<Number>(field, otherwise) : otherwise;
}

int small_option(const FileOperator& from, int field, int otherwise) {
  const int value = option<std::int32_t>(from, field, otherwise);
  constexpr int kMost = 4096;
  require_supported(value >= 1 && value <= kMost, "a stride, dilation or block of " + std::to_string(value));
  return value;
}

// The numbers in a constant, such as the axes of a mean.
const std::vector<int>& integers(const NetworkGraph& graph, const FileOperator& from, std::size_t input) {
  require_supported(input < from.inputs.size(), "an operator without its sizes");
  return graph.tensors[from.inputs[input]].integers;
}

void clip(NetworkNode& node, int activation) {
  constexpr int kNone = 0, kRelu = 1, kRelu6 = 3;
  require_supported(activation == kNone || activation == kRelu || activation == kRelu6,
                    "activation function " + std::to_string(activation));
  if (activation != kNone) {
    node.lowest = 0.0F;
  }
  if (activation == kRelu6) {
    node.highest = 6.0F;
  }
}

NetworkNode node_of(NodeKind kind, const FileOperator& from, std::size_t inputs) {
  require_supported(from.inputs.size() >= inputs, "an operator without its inputs");
  NetworkNode node;
  node.kind = kind;
  node.inputs.assign(from.inputs.begin(), from.inputs.begin() + static_cast<std::ptrdiff_t>(inputs));
  node.output = from.output;
  return node;
}

const TensorShape& image_shape(const NetworkGraph& graph, int tensor) {
  const TensorShape& shape = graph.tensors[tensor].shape;
  require_supported(shape.size() == 4, "a window over an array that is not an image");
  return shape;
}

// Zeros before and after an image so that its size is divided by the stride alone.
std::pair<int, int> same_padding(int size, int kernel, int stride, int dilation) {
  const int outputs = (size + stride - 1) / stride;
  const int total = std::max((outputs - 1) * stride + (kernel - 1) * dilation + 1 - size, 0);
  return {total / 2, total - total / 2};
}

void set_padding(NetworkWindow& w, const TensorShape& image, int padding) {
  constexpr int kSame = 0;
  if (padding == kSame) {
    std::tie(w.top, w.bottom) = same_padding(image[1], w.height, w.stride_height, w.dilation_height);
    std::tie(w.left, w.right) = same_padding(image[2], w.width, w.stride_width, w.dilation_width);
  }
}

// A convolution reads the image before its padding, if only rows and columns were padded.
void fold_padding(const NetworkGraph& graph, NetworkNode& node) {
  const auto pad = std::find_if(graph.nodes.begin(), graph.nodes.end(), [&](const NetworkNode& other) {
    return other.kind == NodeKind::pad && other.output == node.inputs[0];
  });
  if (pad == graph.nodes.end() || pad->before.size() != 4 || pad->before[0] + pad->after[0] != 0 ||
      pad->before[3] + pad->after[3] != 0) {
    return;
  }
  node.inputs[0] = pad->inputs[0];
  node.window.top += pad->before[1];
  node.window.left += pad->before[2];
  node.window.bottom += pad->after[1];
  node.window.right += pad->after[2];
}

void append_convolution(const FileOperator& from, NetworkGraph& graph) {
  const bool depthwise = from.code == 4;
  NetworkNode node = node_of(depthwise ? NodeKind::depthwise_convolution : NodeKind::convolution, from,
                             std::min<std::size_t>(std::max<std::size_t>(from.inputs.size(), 2), 3));
  const TensorShape& weights = image_shape(graph, node.inputs[1]);
  const int shift = depthwise ? 1 : 0;  // the depthwise options have the multiplier before the activation
  node.window = {.height = weights[1],
                 .width = weights[2],
                 .stride_height = small_option(from, 2, 1),
                 .stride_width = small_option(from, 1, 1),
                 .dilation_height = small_option(from, 5 + shift, 1),
                 .dilation_width = small_option(from, 4 + shift, 1)};
  clip(node, option<std::int8_t>(from, 3 + shift));
  set_padding(node.window, image_shape(graph, node.inputs[0]), option<std::int8_t>(from, 0));
  fold_padding(graph, node);
  graph.nodes.push_back(node);
}

void append_fully_connected(const FileOperator& from, NetworkGraph& graph) {
  NetworkNode node = node_of(NodeKind::fully_connected, from,
                             std::min<std::size_t>(std::max<std::size_t>(from.inputs.size(), 2), 3));
  clip(node, option<std::int8_t>(from, 0));
  require_supported(option<std::int8_t>(from, 1) == 0, "a shuffled weight format");
  graph.nodes.push_back(node);
}

void append_sum_or_product(const FileOperator& from, NetworkGraph& graph) {
  NetworkNode node = node_of(from.code == 0 ? NodeKind::add : NodeKind::multiply, from, 2);
  clip(node, option<std::int8_t>(from, 0));
  graph.nodes.push_back(node);
}

void append_pool(const FileOperator& from, NetworkGraph& graph) {
  NetworkNode node = node_of(NodeKind::max_pool, from, 1);
  const TensorShape& image = image_shape(graph, node.inputs[0]);
  node.window = {.height = small_option(from, 4, 1),
                 .width = small_option(from, 3, 1),
                 .stride_height = small_option(from, 2, 1),
                 .stride_width = small_option(from, 1, 1)};
  clip(node, option<std::int8_t>(from, 5));
  set_padding(node.window, image, option<std::int8_t>(from, 0));
  graph.nodes.push_back(node);
}

void append_mean(const FileOperator& from, NetworkGraph& graph) {
  NetworkNode node = node_of(NodeKind::average_pool, from, 1);
  require_supported(integers(graph, from, 1) == std::vector<int>{1, 2},
                    "a mean over other axes than height and width");
  if (option<std::int8_t>(from, 0) == 0) {  // the averages come out as a vector
    NetworkNode flatten;
    flatten.kind = NodeKind::reshape;
    flatten.inputs = {static_cast<int>(graph.tensors.size())};
    flatten.output = node.output;
    node.output = flatten.inputs[0];
    graph.tensors.push_back({.shape = {1, 1, 1, image_shape(graph, node.inputs[0])[3]},
                             .values = {},
                             .integers = {},
                             .name = {}});
    graph.nodes.push_back(node);
    graph.nodes.push_back(flatten);
  } else {
    graph.nodes.push_back(node);
  }
}

void append_pad(const FileOperator& from, NetworkGraph& graph) {
  NetworkNode node = node_of(NodeKind::pad, from, 1);
  const std::vector<int>& amounts = integers(graph, from, 1);
  constexpr int kMost = 4096;
  for (std::size_t i = 0; i + 1 < amounts.size(); i += 2) {
    require_supported(
        amounts[i] >= 0 && amounts[i] <= kMost && amounts[i + 1] >= 0 && amounts[i + 1] <= kMost,
        "a negative or very large padding");
    node.before.push_back(amounts[i]);
    node.after.push_back(amounts[i + 1]);
  }
  graph.nodes.push_back(node);
}

void append_resize(const FileOperator& from, NetworkGraph& graph) {
  require_supported(option<std::int8_t>(from, 2) == 0 && option<std::int8_t>(from, 3) != 0,
                    "a resize that does not keep the centres of pixels");
  graph.nodes.push_back(node_of(NodeKind::resize_bilinear, from, 1));
}

void append_depth_to_space(const FileOperator& from, NetworkGraph& graph) {
  NetworkNode node = node_of(NodeKind::depth_to_space, from, 1);
  node.block = small_option(from, 0, 1);
  graph.nodes.push_back(node);
}

void append_concatenation(const FileOperator& from, NetworkGraph& graph) {
  require_supported(option<std::int32_t>(from, 0) == 1 && option<std::int8_t>(from, 1) == 0,
                    "a concatenation along another axis than the second");
  graph.nodes.push_back(node_of(NodeKind::concatenate, from, std::max<std::size_t>(from.inputs.size(), 1)));
}

void append_prelu(const FileOperator& from, NetworkGraph& graph) {
  const NetworkNode node = node_of(NodeKind::prelu, from, 2);
  NetworkTensor& slopes = graph.tensors[node.inputs[1]];
  slopes.shape = {static_cast<int>(slopes.values.size())};
  graph.nodes.push_back(node);
}

// The first channels of an image, as a convolution that multiplies them by 1.
void append_slice(const FileOperator& from, NetworkGraph& graph) {
  NetworkNode node = node_of(NodeKind::convolution, from, 1);
  const TensorShape in = image_shape(graph, node.inputs[0]);
  const TensorShape out = image_shape(graph, node.output);
  require_supported(out[1] == in[1] && out[2] == in[2] && out[3] <= in[3] &&
                        integers(graph, from, 1).size() == 4 &&
                        integers(graph, from, 1) == std::vector<int>(4, 0) &&
                        integers(graph, from, 3) == std::vector<int>(4, 1),
                    "a slice of something else than the first channels");
  NetworkTensor weights{.shape = {out[3], 1, 1, in[3]}, .values = {}, .integers = {}, .name = {}};
  weights.values.assign(element_count(weights.shape), 0.0F);
  for (int channel = 0; channel < out[3]; ++channel) {
    weights.values[static_cast<std::size_t>(channel) * in[3] + channel] = 1.0F;
  }
  node.inputs.push_back(static_cast<int>(graph.tensors.size()));
  graph.tensors.push_back(std::move(weights));
  graph.nodes.push_back(node);
}

template <NodeKind kind>
void append_simple(const FileOperator& from, NetworkGraph& graph) {
  NetworkNode node = node_of(kind, from, 1);
  if (kind == NodeKind::clamp) {
    node.lowest = 0.0F;
  }
  graph.nodes.push_back(node);
}

struct Operator {
  int code;
  void (*append)(const FileOperator&, NetworkGraph&);
};
constexpr std::array<Operator, 16> kOperators = {{
    {0, append_sum_or_product},
    {2, append_concatenation},
    {3, append_convolution},
    {4, append_convolution},
    {5, append_depth_to_space},
    {9, append_fully_connected},
    {14, append_simple<NodeKind::sigmoid>},
    {17, append_pool},
    {18, append_sum_or_product},
    {19, append_simple<NodeKind::clamp>},
    {22, append_simple<NodeKind::reshape>},
    {23, append_resize},
    {34, append_pad},
    {40, append_mean},
    {45, append_slice},
    {54, append_prelu},
}};

}  // namespace

bool copies_constant(const FileOperator& from) {
  return from.code == kDequantize || from.code == kDensify;
}

void append_nodes(const FileOperator& from, NetworkGraph& graph) {
  const auto found = std::find_if(kOperators.begin(), kOperators.end(),
                                  [&](const Operator& candidate) { return candidate.code == from.code; });
  if (found == kOperators.end()) {
    unsupported(from.code == kCustom ? "its own operator " + from.custom
                                     : "operator " + std::to_string(from.code));
  }
  found->append(from, graph);
}

}  // namespace telemime
