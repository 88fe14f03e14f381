// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/nets/network_graph.h"

namespace telemime {

/// Throws Error(config) unless the shape of the node's output and those of its weights follow from its
/// inputs.
void check_shapes(const NetworkGraph& graph, const NetworkNode& node);

}  // namespace telemime
