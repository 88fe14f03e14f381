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
  return telemime::fuzz_one(data, size, read, telemime::ErrorKind::config);
}
