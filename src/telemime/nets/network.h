// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "telemime/nets/network_graph.h"

namespace telemime {

/// A small neural network that runs on one thread of the processor (XNNPACK). The same input gives the same
/// bytes on the same processor. Not to be used by two threads at once; two networks are independent.
class Network {
 public:
  /// From the bytes of a TensorFlow Lite file. What the outputs of the part do not need is not computed.
  /// Throws Error(config) as read_network_graph does.
  explicit Network(std::span<const std::byte> file, const NetworkPart& part = {});
  Network(Network&&) noexcept;
  Network& operator=(Network&&) noexcept;
  ~Network();

  const TensorShape& input_shape(std::size_t input = 0) const;

  /// Computes the outputs: for each its numbers, row-major, valid until the next run. Throws Error(usage)
  /// unless there is one span for each input, of the size of its input_shape().
  std::span<const std::span<const float>> run(std::span<const std::span<const float>> inputs);
  /// The same of a network with one input.
  std::span<const std::span<const float>> run(std::span<const float> input) {
    return run(std::span(&input, 1));
  }

 private:
  struct Runtime;
  std::unique_ptr<Runtime> runtime_;
};

}  // namespace telemime
