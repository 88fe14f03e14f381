// SPDX-License-Identifier: Apache-2.0
#include "fuzz_target.h"
#include "telemime/core/errors.h"
#include "telemime/tracker/config.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = [](std::string_view text) {
    telemime::Config config;
    update(config, telemime::parse_settings(text, "fuzz"));
  };
  return telemime::fuzz_one(data, size, read, telemime::ErrorKind::config);
}
