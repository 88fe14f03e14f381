// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/network_operators.h"

#include <algorithm>

namespace telemime {
namespace {

void require_image(const TensorShape& shape) {
  require_intact(shape.size() == 4 && shape[0] == 1, "an operator on images has another input");
}

int windows(int size, int before, int after, int kernel, int stride, int dilation) {
  const int span = (kernel - 1) * dilation + 1;
  const int padded = size + before + after;
  require_intact(padded >= span, "a window is larger than its image");
  return (padded - span) / stride + 1;
}

TensorShape windowed(const TensorShape& in, const NetworkWindow& w, int channels) {
  require_image(in);
  return {1, windows(in[1], w.top, w.bottom, w.height, w.stride_height, w.dilation_height),
          windows(in[2], w.left, w.right, w.width, w.stride_width, w.dilation_width), channels};
}

TensorShape broadcast(const TensorShape& a, const TensorShape& b) {
  TensorShape shape(std::max(a.size(), b.size()), 1);
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const int left = i < a.size() ? a[a.size() - 1 - i] : 1;
    const int right = i < b.size() ? b[b.size() - 1 - i] : 1;
    require_intact(left == right || left == 1 || right == 1, "two arrays of different shapes are combined");
    shape[shape.size() - 1 - i] = std::max(left, right);
  }
  return shape;
}

TensorShape concatenated(const NetworkGraph& graph, const NetworkNode& node) {
  TensorShape shape = graph.tensors[node.inputs[0]].shape;
  require_intact(shape.size() >= 2 && shape[0] == 1, "arrays are joined along their first dimension");
  shape[1] = 0;
  for (const int input : node.inputs) {
    const TensorShape& part = graph.tensors[input].shape;
    require_intact(part.size() == shape.size() && part[0] == 1 &&
                       std::equal(part.begin() + 2, part.end(), shape.begin() + 2),
                   "arrays of different shapes are joined");
    shape[1] += part[1];
  }
  return shape;
}

void check_weights(const NetworkGraph& graph, const NetworkNode& node, const TensorShape& expected) {
  require_intact(node.inputs.size() >= 2 && graph.tensors[node.inputs[1]].shape == expected &&
                     !graph.tensors[node.inputs[1]].values.empty(),
                 "weights do not fit their operator");
  if (node.inputs.size() > 2) {
    const int outputs = node.kind == NodeKind::depthwise_convolution ? expected.back() : expected.front();
    const NetworkTensor& bias = graph.tensors[node.inputs[2]];
    require_intact(bias.shape == TensorShape{outputs} && !bias.values.empty(),
                   "a bias does not fit its operator");
  }
}

TensorShape output_shape(const NetworkGraph& graph, const NetworkNode& node, const TensorShape& declared) {
  const TensorShape& in = graph.tensors[node.inputs[0]].shape;
  const NetworkWindow& w = node.window;
  switch (node.kind) {
    case NodeKind::convolution:
      require_image(in);
      check_weights(graph, node, {declared.back(), w.height, w.width, in[3]});
      return windowed(in, w, declared.back());
    case NodeKind::depthwise_convolution:
      require_image(in);
      check_weights(graph, node, {1, w.height, w.width, in[3]});
      return windowed(in, w, in[3]);
    case NodeKind::fully_connected:
      require_intact(in.size() == 2 && in[0] == 1, "a fully connected layer has another input than a vector");
      check_weights(graph, node, {declared.back(), in[1]});
      return {1, declared.back()};
    case NodeKind::add:
    case NodeKind::multiply:
      return broadcast(in, graph.tensors[node.inputs[1]].shape);
    case NodeKind::max_pool:
      return windowed(in, w, in.back());
    case NodeKind::average_pool:
      require_image(in);
      return {1, 1, 1, in[3]};
    case NodeKind::resize_bilinear:
      require_image(in);
      require_intact(declared.size() == 4, "an image is resized to no image");
      return {1, declared[1], declared[2], in[3]};
    case NodeKind::reshape:
      require_intact(element_count(in) == element_count(declared),
                     "a reshape changes the number of elements");
      return declared;
    case NodeKind::prelu: {
      require_image(in);
      const NetworkTensor& slopes = graph.tensors[node.inputs[1]];
      require_intact(slopes.shape == TensorShape{in[3]} && !slopes.values.empty(),
                     "slopes do not fit their operator");
      return in;
    }
    case NodeKind::depth_to_space:
      require_image(in);
      require_intact(in[3] % (node.block * node.block) == 0, "channels cannot be divided into blocks");
      return {1, in[1] * node.block, in[2] * node.block, in[3] / (node.block * node.block)};
    case NodeKind::concatenate:
      return concatenated(graph, node);
    case NodeKind::pad: {
      require_intact(node.before.size() == in.size() && node.after.size() == in.size(),
                     "a padding has other dimensions");
      TensorShape shape = in;
      for (std::size_t i = 0; i < shape.size(); ++i) {
        shape[i] += node.before[i] + node.after[i];
      }
      return shape;
    }
    case NodeKind::sigmoid:
    case NodeKind::clamp:
      return in;
  }
  return in;
}

}  // namespace

void check_shapes(const NetworkGraph& graph, const NetworkNode& node) {
  const TensorShape& declared = graph.tensors[node.output].shape;
  require_intact(!declared.empty(), "an operator has an output without a shape");
  require_intact(output_shape(graph, node, declared) == declared,
                 "the shape of an output does not follow from its inputs");
}

}  // namespace telemime
