// SPDX-License-Identifier: Apache-2.0
#include <span>
#include <vector>

#include "fuzz_target.h"
#include "telemime/nets/network.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = [](std::string_view file) {
    telemime::Network network(std::as_bytes(std::span(file)));
    network.run(std::vector<float>(telemime::element_count(network.input_shape()), 0.5F));
  };
  const auto read_half = [](std::string_view file) {
    const telemime::NetworkPart half{.inputs = {}, .outputs = {}, .rows = {.bands = 1, .parts = 2}};
    telemime::Network network(std::as_bytes(std::span(file)), half);
    network.run(std::vector<float>(telemime::element_count(network.input_shape()), 0.5F));
  };
  telemime::fuzz_one(data, size, read_half, telemime::ErrorKind::config);
  return telemime::fuzz_one(data, size, read, telemime::ErrorKind::config);
}
