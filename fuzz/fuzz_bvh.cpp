// SPDX-License-Identifier: Apache-2.0
#include "fuzz_target.h"
#include "telemime/outputs/bvh/bvh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return telemime::fuzz_one(data, size, [](std::string_view text) {
    const telemime::BvhFile file = telemime::parse_bvh(text, "fuzz");
    for (std::size_t frame = 0; frame < file.frames.size(); ++frame) {
      telemime::bvh_world(file, frame);
    }
  });
}
