// SPDX-License-Identifier: Apache-2.0
#include "fuzz_target.h"
#include "telemime/outputs/bap/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return telemime::fuzz_one(data, size, [](std::string_view text) {
    const telemime::BapProfile& profile = telemime::bap_profile("iso");
    telemime::BapValues values{};
    telemime::Pose pose;
    for (const telemime::BapFrame& frame : telemime::parse_bap(text, "fuzz").frames) {
      values = telemime::values_of(profile, frame, values);
      pose = telemime::decode_bap(profile, values, pose);
    }
  });
}
