// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/network.h"

#include <algorithm>
#include <iterator>

#include "telemime/core/errors.h"
#include "telemime/nets/subgraph.h"

namespace telemime {
namespace {

constexpr std::size_t kSpare = XNN_EXTRA_BYTES / sizeof(float);  // XNNPACK reads that far beyond an array

// The nodes that join parts into an output: this version of XNNPACK cannot, so they write to one buffer.
const NetworkNode* joined(const NetworkGraph& graph, int output) {
  const auto node = std::find_if(graph.nodes.begin(), graph.nodes.end(), [&](const NetworkNode& candidate) {
    return candidate.kind == NodeKind::concatenate && candidate.output == output;
  });
  return node == graph.nodes.end() ? nullptr : &*node;
}

}  // namespace

struct Network::Runtime {
  NetworkGraph graph;
  std::vector<std::vector<float>> inputs, outputs;
  std::vector<std::span<const float>> views;  // of the outputs
  RuntimeHandle handle;

  std::vector<float> buffer_of(int tensor) const {
    return std::vector<float>(element_count(graph.tensors[tensor].shape) + kSpare, 0.0F);
  }

  void prepare() {
    std::vector<ExternalTensor> external;
    for (const int input : graph.inputs) {
      inputs.push_back(buffer_of(input));
      external.push_back({input, inputs.back().data()});
    }
    for (const int output : graph.outputs) {
      outputs.push_back(buffer_of(output));
      float* place = outputs.back().data();
      views.emplace_back(place, element_count(graph.tensors[output].shape));
      const NetworkNode* const join = joined(graph, output);
      if (join == nullptr) {
        external.push_back({output, place});
        continue;
      }
      for (const int part : join->inputs) {
        external.push_back({part, place});
        place += element_count(graph.tensors[part].shape);
      }
    }
    refuse_unusual_joins(external);
    handle = make_runtime(graph, external);
  }

  // A part may belong to one output alone, must be computed, and a joined array must be an output.
  void refuse_unusual_joins(const std::vector<ExternalTensor>& external) const {
    std::vector<int> written;
    std::transform(external.begin(), external.end(), std::back_inserter(written),
                   [](const ExternalTensor& each) { return each.tensor; });
    std::sort(written.begin(), written.end());
    bool usual = std::adjacent_find(written.begin(), written.end()) == written.end();
    for (const NetworkNode& node : graph.nodes) {
      const bool joins = node.kind == NodeKind::concatenate;
      usual = usual && (!joins || std::count(graph.outputs.begin(), graph.outputs.end(), node.output) == 1);
      for (const int input_of_node : node.inputs) {
        const NetworkTensor& tensor = graph.tensors[input_of_node];
        usual = usual && (joins ? !tensor.is_constant() && joined(graph, input_of_node) == nullptr
                                : joined(graph, input_of_node) == nullptr &&
                                      (!tensor.is_constant() || !tensor.values.empty()));
      }
    }
    if (!usual) {
      throw Error(ErrorKind::config,
                  "the network file cannot be used: arrays are joined inside of the network",
                  "Use the models that Telemime was built with.");
    }
  }
};

Network::Network(std::span<const std::byte> file, const NetworkPart& part)
    : runtime_(std::make_unique<Runtime>()) {
  runtime_->graph = read_network_graph(file, part);
  runtime_->prepare();
}

Network::Network(Network&&) noexcept = default;
Network& Network::operator=(Network&&) noexcept = default;
Network::~Network() = default;

const TensorShape& Network::input_shape(std::size_t input) const {
  return runtime_->graph.tensors[runtime_->graph.inputs.at(input)].shape;
}

std::span<const std::span<const float>> Network::run(std::span<const std::span<const float>> inputs) {
  bool fits = inputs.size() == runtime_->inputs.size();
  for (std::size_t i = 0; fits && i < inputs.size(); ++i) {
    fits = inputs[i].size() == element_count(input_shape(i));
  }
  if (!fits) {
    throw Error(ErrorKind::usage, "the input of a network has another size than the network");
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    std::copy(inputs[i].begin(), inputs[i].end(), runtime_->inputs[i].begin());
  }
  if (xnn_invoke_runtime(runtime_->handle.get()) != xnn_status_success) {
    throw Error(ErrorKind::config, "a network could not be computed");
  }
  return runtime_->views;
}

}  // namespace telemime
