// SPDX-License-Identifier: Apache-2.0
#include "fuzz_target.h"
#include "telemime/evaluation/report.h"
#include "telemime/evaluation/truth.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return telemime::fuzz_one(data, size, [](std::string_view text) {
    const telemime::Truth truth = telemime::parse_truth(text, "fuzz");
    telemime::MotionFrame frame;
    frame.state = telemime::TrackState::tracking;
    for (std::size_t j = 0; j < telemime::kJointCount; ++j) {
      frame.joints.at[j] = {0.1 * static_cast<double>(j), 0.2, 1.5};
      frame.pixels[j] = truth.camera.project(frame.joints.at[j]);
    }
    telemime::evaluation_table(telemime::evaluate({frame}, truth.camera, truth, {}));
  });
}
