// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/nets/flat_table.h"
#include "telemime/nets/network_graph.h"
#include "telemime/nets/network_operators.h"

namespace telemime {
namespace {

constexpr std::size_t kMostElements = std::size_t{1} << 27U;  // of all arrays of a network

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

bool is_input(const NetworkGraph& graph, int tensor) {
  return std::find(graph.inputs.begin(), graph.inputs.end(), tensor) != graph.inputs.end();
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
    for (const int input : graph.inputs) {
      require_intact(!known_[input], "an input is a constant");
      known_[input] = true;
    }
  }

  void add(const FlatTable& from) {
    FileOperator op = resolve(from);
    require_intact(!known_[op.output], "an array is computed twice");
    known_[op.output] = true;
    if (copies_constant(op)) {
      require_intact(op.inputs.size() == 1 && graph_.tensors[op.inputs[0]].is_constant() &&
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
      require_intact(
          known_[output] && !graph_.tensors[same_as_[output]].is_constant() && !is_input(graph_, output),
          "an output is not computed");
    }
  }

 private:
  FileOperator resolve(const FlatTable& from) const {
    const auto code = from.number<std::uint32_t>(0);
    const std::vector<std::int32_t> outputs = from.numbers<std::int32_t>(2);
    require_intact(code < codes_.size() && outputs.size() == 1 && outputs[0] >= 0 &&
                       static_cast<std::size_t>(outputs[0]) < known_.size(),
                   "an operator has no code or output");
    FileOperator op{.code = codes_[code].code,
                    .custom = codes_[code].custom,
                    .inputs = {},
                    .output = outputs[0],
                    .options = from.table(4)};
    for (const std::int32_t input : from.numbers<std::int32_t>(1)) {
      if (input == -1) {
        break;  // an operator's optional inputs are its last ones
      }
      require_intact(input >= 0 && static_cast<std::size_t>(input) < known_.size() && known_[input] &&
                         !graph_.tensors[same_as_[input]].shape.empty(),
                     "an operator reads an array before it is computed");
      op.inputs.push_back(same_as_[input]);
    }
    require_intact(!op.inputs.empty(), "an operator has no input");
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
    require_intact(index >= 0 && static_cast<std::size_t>(index) < count, "an array does not exist");
  }
  return list;
}

// The tensor of this name: an input, or what an operator computes.
int computed_tensor(const NetworkGraph& graph, const std::string& name, const char* role) {
  const auto is_named = [&](const NetworkTensor& tensor) { return tensor.name == name; };
  const auto found = std::find_if(graph.tensors.begin(), graph.tensors.end(), is_named);
  if (found == graph.tensors.end() || found->is_constant() || found->shape.empty()) {
    throw Error(ErrorKind::config, "the network has no " + std::string(role) + " " + name,
                "Install the models again.");
  }
  return static_cast<int>(found - graph.tensors.begin());
}

// Backwards: an operator is needed if a later one reads what it computes. Returns the needed ones in order.
std::vector<FlatTable> needed_operators(const std::vector<FlatTable>& operators, const NetworkGraph& graph) {
  std::vector<bool> needed(graph.tensors.size(), false);
  for (const int output : graph.outputs) {
    needed[output] = true;
  }
  std::vector<FlatTable> kept;
  // NOLINTNEXTLINE(modernize-loop-convert): clang 14 cannot read std::views::reverse of GCC's library
  for (auto from = operators.rbegin(); from != operators.rend(); ++from) {
    const std::vector<std::int32_t> outputs = from->numbers<std::int32_t>(2);
    const bool keep = std::any_of(outputs.begin(), outputs.end(), [&](std::int32_t output) {
      return output < 0 || static_cast<std::size_t>(output) >= needed.size() ||
             (needed[output] && !is_input(graph, output));
    });
    for (const std::int32_t input : keep ? from->numbers<std::int32_t>(1) : std::vector<std::int32_t>{}) {
      if (input >= 0 && static_cast<std::size_t>(input) < needed.size()) {
        needed[input] = true;
      }
    }
    if (keep) {
      kept.push_back(*from);
    }
  }
  std::reverse(kept.begin(), kept.end());
  return kept;
}

// Keeps only these rows of all images.
void keep_rows(NetworkGraph& graph, const RowShare& rows) {
  if (!(rows.bands > 0 && rows.bands <= rows.parts)) {
    throw Error(ErrorKind::usage, "a network was asked for a share of rows that does not exist");
  }
  if (rows.bands == rows.parts) {
    return;
  }
  std::vector<int> computed = graph.inputs;
  std::transform(graph.nodes.begin(), graph.nodes.end(), std::back_inserter(computed),
                 [](const NetworkNode& node) { return node.output; });
  bool can_be_cut = std::none_of(graph.nodes.begin(), graph.nodes.end(),
                                 [](const NetworkNode& node) { return node.kind == NodeKind::concatenate; });
  for (const int tensor : computed) {
    TensorShape& shape = graph.tensors[tensor].shape;
    can_be_cut = can_be_cut && shape.size() == 4 && shape[1] % rows.parts == 0;
    if (!can_be_cut) {
      throw Error(ErrorKind::config, "the images of the network cannot be cut into these bands",
                  "Install the models again.");
    }
    shape[1] = shape[1] / rows.parts * rows.bands;
  }
  for (const NetworkNode& node : graph.nodes) {
    check_shapes(graph, node);
  }
}

// Removes the nodes that became part of others, and the numbers of constants that no node reads.
void remove_unused(NetworkGraph& graph) {
  std::vector<bool> needed(graph.tensors.size(), false);
  for (const std::vector<int>& ends : {graph.inputs, graph.outputs}) {
    for (const int tensor : ends) {
      needed[tensor] = true;
    }
  }
  std::vector<NetworkNode> nodes;
  std::reverse(graph.nodes.begin(), graph.nodes.end());
  for (NetworkNode& node : graph.nodes) {
    if (needed[node.output]) {
      for (const int input : node.inputs) {
        needed[input] = true;
      }
      nodes.push_back(std::move(node));
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
}

}  // namespace

NetworkGraph read_network_graph(std::span<const std::byte> file, const NetworkPart& part) {
  const FlatTable model = FlatTable::root(file, "TFL3");
  const std::vector<FlatTable> subgraphs = model.tables(2);
  require_intact(subgraphs.size() == 1, "it has not exactly one graph");
  const std::vector<FlatTable> buffers = model.tables(4);

  NetworkGraph graph;
  std::size_t total = 0;
  for (const FlatTable& tensor : subgraphs[0].tables(0)) {
    graph.tensors.push_back(read_tensor(tensor, buffers));
    total += element_count(graph.tensors.back().shape);
    require_intact(total <= kMostElements, "its arrays are too large");
  }
  const std::vector<int> inputs = tensor_list(subgraphs[0], 1, graph.tensors.size());
  require_intact(inputs.size() == 1 && !graph.tensors[inputs[0]].shape.empty(),
                 "it has not exactly one input");
  const auto named = [&graph](const std::vector<std::string>& names, const char* role) {
    std::vector<int> tensors;
    std::transform(names.begin(), names.end(), std::back_inserter(tensors),
                   [&](const std::string& name) { return computed_tensor(graph, name, role); });
    return tensors;
  };
  graph.inputs = part.inputs.empty() ? inputs : named(part.inputs, "input");
  graph.outputs = part.outputs.empty() ? tensor_list(subgraphs[0], 2, graph.tensors.size())
                                       : named(part.outputs, "output");

  GraphBuilder builder(graph, read_codes(model));
  for (const FlatTable& from : needed_operators(subgraphs[0].tables(3), graph)) {
    builder.add(from);
  }
  builder.check_outputs();
  remove_unused(graph);
  keep_rows(graph, part.rows);
  return graph;
}

}  // namespace telemime
