// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/subgraph.h"

#include <algorithm>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

void check(xnn_status status) {
  if (status != xnn_status_success) {
    throw Error(
        ErrorKind::config,
        "the network cannot be prepared: XNNPACK reports error " + std::to_string(static_cast<int>(status)),
        "Free some memory, or install the models again.");
  }
}

std::vector<std::size_t> dimensions(const TensorShape& shape) {
  return {shape.begin(), shape.end()};
}

// Defines the arrays and nodes of a graph for XNNPACK.
class SubgraphBuilder {
 public:
  SubgraphBuilder(const NetworkGraph& graph, const std::vector<ExternalTensor>& external)
      : graph_(graph), ids_(graph.tensors.size(), XNN_INVALID_VALUE_ID) {
    xnn_subgraph_t subgraph = nullptr;
    check(xnn_create_subgraph(static_cast<std::uint32_t>(external.size()), 0, &subgraph));
    subgraph_.reset(subgraph);
    for (std::uint32_t i = 0; i < external.size(); ++i) {
      const int tensor = external[i].tensor;
      const bool given = std::count(graph.inputs.begin(), graph.inputs.end(), tensor) > 0;
      define_tensor(tensor, i, given ? XNN_VALUE_FLAG_EXTERNAL_INPUT : XNN_VALUE_FLAG_EXTERNAL_OUTPUT);
    }
  }

  void add(const NetworkNode& node) {
    if (node.kind == NodeKind::concatenate) {
      return;  // its inputs are written where its output is
    }
    std::vector<std::uint32_t> in;
    for (const int input : node.inputs) {
      in.push_back(id(input));
    }
    const std::uint32_t weights = in.size() > 1 ? in[1] : XNN_INVALID_VALUE_ID;
    const std::uint32_t bias = in.size() > 2 ? in[2] : XNN_INVALID_VALUE_ID;
    check(define(node, in[0], weights, bias, id(node.output)));
  }

  xnn_subgraph_t subgraph() const { return subgraph_.get(); }

 private:
  std::uint32_t id(int tensor) {
    if (ids_[tensor] == XNN_INVALID_VALUE_ID) {
      define_tensor(tensor, XNN_INVALID_VALUE_ID, 0);
    }
    return ids_[tensor];
  }

  void define_tensor(int index, std::uint32_t external, std::uint32_t flags) {
    const NetworkTensor& tensor = graph_.tensors[index];
    const std::vector<std::size_t> sizes = dimensions(tensor.shape);
    check(xnn_define_tensor_value(subgraph_.get(), xnn_datatype_fp32, sizes.size(), sizes.data(),
                                  tensor.values.empty() ? nullptr : tensor.values.data(), external, flags,
                                  &ids_[index]));
  }

  std::size_t channels(int tensor) const {
    return static_cast<std::size_t>(graph_.tensors[tensor].shape.back());
  }

  xnn_status define(const NetworkNode& node, std::uint32_t in, std::uint32_t weights, std::uint32_t bias,
                    std::uint32_t out) {
    xnn_subgraph_t to = subgraph_.get();
    const TensorShape& shape = graph_.tensors[node.output].shape;
    switch (node.kind) {
      case NodeKind::convolution:
      case NodeKind::depthwise_convolution:
        return define_convolution(node, in, weights, bias, out);
      case NodeKind::fully_connected:
        return xnn_define_fully_connected(to, node.lowest, node.highest, in, weights, bias, out, 0);
      case NodeKind::add:
        return xnn_define_add2(to, node.lowest, node.highest, in, weights, out, 0);
      case NodeKind::multiply:
        return xnn_define_multiply2(to, node.lowest, node.highest, in, weights, out, 0);
      case NodeKind::max_pool: {
        const NetworkWindow& w = node.window;
        return xnn_define_max_pooling_2d(to, w.top, w.right, w.bottom, w.left, w.height, w.width,
                                         w.stride_height, w.stride_width, 1, 1, node.lowest, node.highest, in,
                                         out, 0);
      }
      case NodeKind::average_pool:
        return xnn_define_global_average_pooling_2d(to, node.lowest, node.highest, in, out, 0);
      case NodeKind::resize_bilinear:
        return xnn_define_static_resize_bilinear_2d(to, shape[1], shape[2], in, out, 0);
      case NodeKind::reshape: {
        const std::vector<std::size_t> sizes = dimensions(shape);
        return xnn_define_static_reshape(to, sizes.size(), sizes.data(), in, out, 0);
      }
      case NodeKind::sigmoid:
        return xnn_define_sigmoid(to, in, out, 0);
      case NodeKind::clamp:
        return xnn_define_clamp(to, node.lowest, node.highest, in, out, 0);
      case NodeKind::prelu:
        return xnn_define_prelu(to, in, weights, out, 0);
      case NodeKind::depth_to_space:
        return xnn_define_depth_to_space(to, in, out, node.block, 0);
      case NodeKind::pad: {
        const std::vector<std::size_t> before = dimensions(node.before);
        const std::vector<std::size_t> after = dimensions(node.after);
        return xnn_define_static_constant_pad(to, before.data(), after.data(), 0.0F, in, out, 0);
      }
      case NodeKind::concatenate:
        break;
    }
    return xnn_status_success;
  }

  xnn_status define_convolution(const NetworkNode& node, std::uint32_t in, std::uint32_t weights,
                                std::uint32_t bias, std::uint32_t out) {
    const NetworkWindow& w = node.window;
    const std::size_t read = channels(node.inputs[0]);
    const std::size_t made = channels(node.output);
    xnn_subgraph_t to = subgraph_.get();
    if (node.kind == NodeKind::depthwise_convolution) {
      return xnn_define_depthwise_convolution_2d(
          to, w.top, w.right, w.bottom, w.left, w.height, w.width, w.stride_height, w.stride_width,
          w.dilation_height, w.dilation_width, 1, read, node.lowest, node.highest, in, weights, bias, out, 0);
    }
    return xnn_define_convolution_2d(to, w.top, w.right, w.bottom, w.left, w.height, w.width, w.stride_height,
                                     w.stride_width, w.dilation_height, w.dilation_width, 1, read, made,
                                     node.lowest, node.highest, in, weights, bias, out, 0);
  }

  const NetworkGraph& graph_;
  std::vector<std::uint32_t> ids_;
  SubgraphHandle subgraph_;
};

}  // namespace

RuntimeHandle make_runtime(const NetworkGraph& graph, const std::vector<ExternalTensor>& external) {
  check(xnn_initialize(nullptr));
  SubgraphBuilder builder(graph, external);
  for (const NetworkNode& node : graph.nodes) {
    builder.add(node);
  }
  xnn_runtime_t made = nullptr;
  check(xnn_create_runtime_v2(builder.subgraph(), nullptr, 0, &made));
  RuntimeHandle runtime(made);
  std::vector<xnn_external_value> places;
  for (std::uint32_t i = 0; i < external.size(); ++i) {
    places.push_back({i, external[i].data});
  }
  check(xnn_setup_runtime(made, places.size(), places.data()));
  return runtime;
}

}  // namespace telemime
