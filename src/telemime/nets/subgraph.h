// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <xnnpack.h>

#include <memory>
#include <vector>

#include "telemime/nets/network_graph.h"

namespace telemime {

/// Deletes objects of XNNPACK.
struct SubgraphDeleter {
  void operator()(xnn_subgraph_t subgraph) const { xnn_delete_subgraph(subgraph); }
  void operator()(xnn_runtime_t runtime) const { xnn_delete_runtime(runtime); }
};
using SubgraphHandle = std::unique_ptr<xnn_subgraph, SubgraphDeleter>;
using RuntimeHandle = std::unique_ptr<xnn_runtime, SubgraphDeleter>;

/// A place where an array of the network begins in the caller's memory.
struct ExternalTensor {
  int tensor = 0;
  float* data = nullptr;
};

/// A network that XNNPACK can run, from its inputs to the other `external` tensors. The weights of the graph
/// must stay where they are. Throws Error(config) if XNNPACK refuses the graph or memory
/// is short.
RuntimeHandle make_runtime(const NetworkGraph& graph, const std::vector<ExternalTensor>& external);

}  // namespace telemime
