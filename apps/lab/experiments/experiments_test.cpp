// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <set>

#include "lab/experiments/experiments.h"
#include "lab/experiments/testing_sequence.h"
#include "telemime/core/errors.h"
#include "telemime/core/scratch_folder.h"

namespace telemime {
namespace {

TEST(Experiments, HaveUniqueIdsAndPublishedValues) {
  std::set<std::string_view> ids;
  for (const Experiment& experiment : experiments()) {
    EXPECT_TRUE(ids.insert(experiment.id).second) << experiment.id;
    EXPECT_FALSE(published_values(std::string(experiment.id)).rows.empty()) << experiment.id;
    EXPECT_EQ(find_experiment(experiment.id), &experiment);
  }
  EXPECT_EQ(find_experiment("F9-9"), nullptr);
}

TEST(Verdict, CountsTheStatementsThatHold) {
  EXPECT_EQ(verdict({true, true}, "x").rfind("Agrees: ", 0), 0U);
  EXPECT_EQ(verdict({true, false}, "x").rfind("Partly agrees: ", 0), 0U);
  EXPECT_EQ(verdict({false}, "x").rfind("Differs: ", 0), 0U);
}

TEST(ReferenceWith, GivesEachStepItsEvaluations) {
  const Model model = make_model(Shape{});
  const auto backend = make_scalar_backend();
  Random random(4);
  const std::vector<Pose> poses = typical_poses(2, random);
  const PreparedFrame frame = frame_of_model(model, poses[0], Camera{}.scaled_to(80, 60));
  const JointLimits limits = anatomical_limits();
  for (const auto& [x, y] : {std::pair{40, 0}, std::pair{0, 30}, std::pair{40, 30}, std::pair{0, 0}}) {
    Objective objective(*backend, frame, model, limits);
    const RegistrationResult found = register_pose(objective, poses[1], reference_with(x, y), random);
    EXPECT_LE(found.region_evaluations, x);
    EXPECT_GE(found.region_evaluations, x - 2);
    EXPECT_LE(found.edge_evaluations, y);
    EXPECT_GE(found.edge_evaluations, y - 2);
  }
}

TEST(TrackSequence, StartsAtTheTruthAndIsRepeatable) {
  const PreparedSequence sequence = testing::model_sequence();
  const Trace still = track_sequence(sequence, reference_with(0, 0), 1);
  ASSERT_EQ(still.region.size(), 3U);
  EXPECT_EQ(still.region[0], 0.0);
  EXPECT_NEAR(still.error_3d[0], 0.0, 1e-6);
  EXPECT_NEAR(still.error_2d[0], 0.0, 1e-6);
  EXPECT_GT(still.error_3d[1], 0.0);

  const Trace alone = track_sequence(sequence, reference_with(60, 40), 1);
  const auto traces = track_all(sequence, {reference_with(60, 40), reference_with(20, 0)}, 1);
  EXPECT_EQ(traces[0].region, alone.region);
  EXPECT_EQ(traces[0].error_3d, alone.error_3d);
  EXPECT_LT(mean_of(alone.region), mean_of(still.region));
}

TEST(Means, LeaveOutWhatIsNotFinite) {
  EXPECT_EQ(mean_of({1.0, std::nan(""), 3.0}), 2.0);
  EXPECT_TRUE(std::isnan(mean_of({})));
  EXPECT_EQ(count_above({1.0, 2.0, 3.0}, 1.5), 2U);
  EXPECT_EQ(median_of({5.0, 1.0, 3.0}), 3.0);
}

TEST(PublishedValues, HaveColumnsAndRows) {
  const Table times = published_values("T3-2");
  EXPECT_EQ(times.columns,
            (std::vector<std::string>{"quantity", "platform 1 ms", "platform 2 ms", "platform 3 ms"}));
  ASSERT_EQ(times.rows.size(), 6U);
  EXPECT_EQ(times.rows.back(), (std::vector<std::string>{"500", "93 +- 10", "101 +- 10", "114 +- 10"}));
  EXPECT_TRUE(published_values("F0-0").rows.empty());
}

TEST(WriteSection, NamesItsTablesAndPicture) {
  const ScratchFolder scratch;
  Section section{"F0-0", "A title", "A question?", {"p", {"k"}, {{"v"}}}, {}};
  section.finding.tables = {{"A table (mm)", {"a"}, {{"1"}}}};
  section.finding.picture = cv::Mat(2, 2, CV_8UC1, cv::Scalar(7));
  section.finding.verdict = "Agrees: yes.";
  write_section(scratch.path(), section);
  const auto json = nlohmann::json::parse(std::ifstream(scratch.path() / "F0-0/section.json"));
  EXPECT_EQ(json["published"], "k\nv\n");
  EXPECT_EQ(json["verdict"], "Agrees: yes.");
  EXPECT_EQ(json["tables"][0]["file"], "a_table_mm.csv");
  EXPECT_TRUE(std::filesystem::exists(scratch.path() / "F0-0/a_table_mm.csv"));
  EXPECT_TRUE(std::filesystem::exists(scratch.path() / "F0-0/picture.png"));
}

TEST(Lab, NeedsAClock) {
  EXPECT_THROW(Lab(LabOptions{}), Error);
}

}  // namespace
}  // namespace telemime
