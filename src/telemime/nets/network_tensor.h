// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "telemime/nets/flat_table.h"
#include "telemime/nets/network_graph.h"

namespace telemime {

/// A tensor of a TensorFlow Lite file. Constants in half precision or sparse form become plain numbers.
/// Throws Error(config) if its shape is unusable or its numbers do not fill it.
NetworkTensor read_tensor(const FlatTable& from, const std::vector<FlatTable>& buffers);

}  // namespace telemime
