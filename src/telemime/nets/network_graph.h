// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace telemime {

/// Sizes of a tensor from the outermost dimension; images are [1, height, width, channels].
using TensorShape = std::vector<int>;

/// The number of elements.
std::size_t element_count(const TensorShape& shape);

/// An array of a network: a constant (weights) if it has values, otherwise computed by a node or an input.
struct NetworkTensor {
  TensorShape shape;
  std::vector<float> values;  ///< of a constant; row-major
  std::vector<int> integers;  ///< of a constant that holds sizes or indices
  std::string name;
  bool is_constant() const { return !values.empty() || !integers.empty(); }
};

enum class NodeKind {
  convolution,            ///< weights [out, height, width, in], bias [out]
  depthwise_convolution,  ///< weights [1, height, width, channels], bias [channels]
  fully_connected,        ///< weights [out, in], bias [out]
  add,
  multiply,
  max_pool,
  average_pool,  ///< over the whole image
  resize_bilinear,
  reshape,
  sigmoid,
  clamp,
  prelu,  ///< slopes [channels]
  depth_to_space,
  concatenate,
  pad,
};

/// The window of a convolution or pooling over [height, width].
struct NetworkWindow {
  int height = 1, width = 1;
  int stride_height = 1, stride_width = 1;
  int dilation_height = 1, dilation_width = 1;
  int top = 0, left = 0, bottom = 0, right = 0;  ///< padding by zeros
};

/// One step of a network. Members that its kind does not need stay at their defaults.
struct NetworkNode {
  NodeKind kind = NodeKind::add;
  std::vector<int> inputs;  ///< indices of tensors: images first, then weights and bias
  int output = 0;
  NetworkWindow window;
  float lowest = -std::numeric_limits<float>::infinity();  ///< the output is clipped to [lowest, highest]
  float highest = std::numeric_limits<float>::infinity();
  int block = 1;                   ///< of depth_to_space
  std::vector<int> before, after;  ///< of pad: elements added in each dimension
};

/// A network as data. Nodes are in an order in which they can be computed; all shapes fit.
struct NetworkGraph {
  std::vector<NetworkTensor> tensors;
  std::vector<NetworkNode> nodes;
  std::vector<int> inputs, outputs;  ///< indices of tensors
};

/// Some of the rows of an image that is divided into `parts` bands of equal height: `bands` neighbouring
/// ones.
struct RowShare {
  int bands = 1;  ///< 1 to parts
  int parts = 1;
};

/// The part of a network that is computed.
struct NetworkPart {
  std::vector<std::string> inputs;   ///< names of the tensors that are given; empty: the network's input
  std::vector<std::string> outputs;  ///< names of the tensors to compute, in this order; empty: its outputs
  /// The rows that are kept of every image, including inputs and outputs. Beyond a cut, windows see zeros
  /// instead of the rows that are missing: rows near it are wrong.
  RowShare rows = {};
};

/// Reads the part of a TensorFlow Lite file whose network has one input, floating-point numbers and static
/// shapes. Weights in half precision or sparse form become plain constants, padding before a convolution
/// becomes part of it, and the slice of the first channels becomes a convolution. Throws Error(config) if the
/// file is damaged, has no tensor of a name, or the part needs other inputs, an operator that is not
/// supported or images that cannot be cut; Error(usage) if there is no such share of rows.
NetworkGraph read_network_graph(std::span<const std::byte> file, const NetworkPart& part = {});

}  // namespace telemime
