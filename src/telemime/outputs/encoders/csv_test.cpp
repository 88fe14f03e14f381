// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/all.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

std::vector<std::vector<std::string>> table(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) {
      rows.back().push_back(cell);
    }
  }
  return rows;
}

TEST(Csv, EveryRowHasEveryColumnAndTheRightNumbers) {
  const StreamHeader header = testing_motion::header();
  auto frames = testing_motion::gesture(header, 4);
  testing_motion::lose(frames, 2);
  Random random(1);
  frames[1].face = testing_motion::random_face(random);
  frames[3].hands.emplace();
  (*frames[3].hands)[1].joints[8] = {0.1, 0.2, 0.5};
  const auto rows = table(testing_motion::encode_all(*make_csv_encoder(), header, frames));
  ASSERT_EQ(rows.size(), 5U);
  const auto cell = [&rows](std::size_t row, const std::string& column) {
    const auto found = std::find(rows[0].begin(), rows[0].end(), column);
    EXPECT_NE(found, rows[0].end()) << column;
    return rows[row].at(static_cast<std::size_t>(found - rows[0].begin()));
  };
  for (std::size_t f = 0; f < frames.size(); ++f) {
    EXPECT_EQ(rows[f + 1].size(), rows[0].size());
    EXPECT_EQ(cell(f + 1, "frame"), std::to_string(f));
    EXPECT_NEAR(std::stod(cell(f + 1, "l_wrist_z_mm")), 1000.0 * frames[f].joints[Joint::l_wrist].z(), 0.01);
    EXPECT_NEAR(std::stod(cell(f + 1, "r_elbow_flexion_deg")),
                frames[f].pose[Angle::r_elbow_flexion] * 180.0 / std::numbers::pi, 1e-4);
    EXPECT_NEAR(std::stod(cell(f + 1, "head_v_px")), frames[f].pixels[2].y(), 1e-3);
    EXPECT_NEAR(std::stod(cell(f + 1, "root_y_mm")), 450.0, 0.01);
  }
  EXPECT_EQ(cell(3, "state"), "lost");
  EXPECT_EQ(cell(3, "r_hand_index_tip_z_mm"), "") << "hands were not tracked";
  EXPECT_NEAR(std::stod(cell(4, "r_hand_index_tip_z_mm")), 500.0, 0.01);
  EXPECT_NEAR(std::stod(cell(4, "l_hand_index_pip_deg")), 30.0, 0.01) << "at rest";
  EXPECT_EQ(cell(4, "evaluations"), "700");
  EXPECT_NEAR(std::stod(cell(2, "jawOpen")), (*frames[1].face)[Expression::jaw_open], 1e-3);
  EXPECT_EQ(cell(1, "face_confidence"), "0.000");
  EXPECT_EQ(cell(1, "head_qw"), "1.000000");
}

}  // namespace
}  // namespace telemime
