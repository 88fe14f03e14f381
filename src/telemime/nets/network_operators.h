// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "telemime/nets/flat_table.h"
#include "telemime/nets/network_graph.h"

namespace telemime {

/// One operator of a TensorFlow Lite file whose tensors have been looked up.
struct FileOperator {
  int code = 0;        ///< BuiltinOperator of the schema
  std::string custom;  ///< name, if the code is that of custom operators
  std::vector<int> inputs;
  int output = 0;
  std::optional<FlatTable> options;
};

/// Whether the operator only gives a constant another number format, so that its output is its input.
bool copies_constant(const FileOperator& from);

/// Appends the node (or nodes) that compute the operator to the graph. Throws Error(config) if the operator
/// or an option is not supported or its constants cannot be used.
void append_nodes(const FileOperator& from, NetworkGraph& graph);

/// A tensor of a TensorFlow Lite file. Constants in half precision or sparse form become plain numbers.
/// Throws Error(config) if its shape is unusable or its numbers do not fill it.
NetworkTensor read_tensor(const FlatTable& from, const std::vector<FlatTable>& buffers);

/// Throws Error(config) unless the shape of the node's output and those of its weights follow from its
/// inputs.
void check_shapes(const NetworkGraph& graph, const NetworkNode& node);

/// Throws Error(config) with `what` is wrong with the file unless it fits.
void require_intact(bool fits, const char* what);

}  // namespace telemime
