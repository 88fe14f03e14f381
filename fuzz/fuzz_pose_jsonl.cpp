// SPDX-License-Identifier: Apache-2.0
#include "fuzz_target.h"
#include "telemime/outputs/readers/jsonl.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return telemime::fuzz_one(data, size,
                            [](std::string_view text) { telemime::parse_pose_jsonl(text, "fuzz"); });
}
