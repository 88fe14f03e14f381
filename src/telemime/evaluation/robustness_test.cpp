// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "telemime/evaluation/report.h"
#include "telemime/evaluation/truth.h"
#include "telemime/outputs/testing_motion.h"
#include "telemime/outputs/testing_mutations.h"

namespace telemime {
namespace {

constexpr std::string_view kTruth = R"({
  "name": "small", "fps": 25, "width": 640, "height": 480, "fx": 554.2, "fy": 554.2, "cx": 319.5, "cy": 239.5,
  "joints": ["l_shoulder", "r_shoulder", "l_elbow", "r_elbow", "l_wrist", "r_wrist", "l_knee"],
  "visible": [false, true, 1], "best_frames": [1, 2], "scale": "unknown",
  "valid": [[1, 1, 1, 1, 1, 1, 0], [1, 1, 1, 1, 1, 1, 0], [1, 1, 0, 1, 1, 1, 0]],
  "positions": [
    [[178, 80, 1300], [-178, 80, 1300], [250, 330, 1290], [-250, 330, 1290], [280, 400, 1080], [-280, 400, 1080], null],
    [[178, 81, 1301], [-178, 82, 1302], [251, 331, 1291], [-251, 331, 1291], [281, 401, 1081], [-281, 401, 1081], null],
    [[178, 82, 1302], [-178, 84, 1304], [252, 332, 1292], [-252, 332, 1292], [282, 402, 1082], [-282, 402, 1082], null]
  ]
})";

TEST(ReaderRobustness, TruthAndWhatIsMeasuredAgainstIt) {
  const StreamHeader header = testing_motion::header();
  const auto frames = testing_motion::gesture(header, 3);
  testing_mutations::expect_robust(std::string(kTruth), [&](std::string_view text) {
    const Truth truth = parse_truth(text, "damaged");
    const Evaluation evaluation = evaluate(frames, header.camera, truth, {});
    EXPECT_FALSE(evaluation_table(evaluation).empty());
    EXPECT_NO_THROW(evaluation_json(evaluation).dump());
  });
}

}  // namespace
}  // namespace telemime
