// SPDX-License-Identifier: Apache-2.0
// What every cue of kCues must obey.
#include "telemime/likelihood/cues/all.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "support/rendered_person.h"

namespace telemime {
namespace {

using support::gestures;
using support::observe;
using testing_poses::kDegree;

struct Perturbation {
  std::string name;
  std::size_t number;  // of the pose vector
  double by;
};

std::vector<Perturbation> perturbations() {
  std::vector<Perturbation> all;
  for (const double sign : {-1.0, 1.0}) {
    all.push_back({"root x", 0, sign * 0.03});
    all.push_back({"root y", 1, sign * 0.03});
    all.push_back({"root z", 2, sign * 0.12});
    const auto turn = [&](Angle a, double degrees) {
      const auto i = static_cast<std::size_t>(a);
      all.push_back({std::string(kAngleNames[i]), 3 + i, sign * degrees * kDegree});
    };
    turn(Angle::root_roll, 8);
    turn(Angle::root_tilt, 15);
    turn(Angle::root_torsion, 20);
    turn(Angle::neck_roll, 15);
    turn(Angle::neck_tilt, 20);
    turn(Angle::l_shoulder_abduct, 12);
    turn(Angle::r_shoulder_abduct, 12);
    turn(Angle::l_shoulder_flexion, 20);
    turn(Angle::r_shoulder_flexion, 20);
    turn(Angle::l_elbow_flexion, 25);
    turn(Angle::r_elbow_flexion, 25);
  }
  return all;
}

Pose perturbed(const Pose& pose, const Perturbation& p) {
  PoseVector v = pose.vector();
  v[static_cast<Eigen::Index>(p.number)] += p.by;
  return Pose::from_vector(v);
}

// Costs of poses on a frame, by any cue.
class Judge {
 public:
  Judge(const Camera& camera, const FrameFeatures& seen) : frame_(prepare(seen, camera)) {}
  double cost(const Cue& cue, const Pose& pose) {
    Score score;
    backend_->evaluate(frame_, model_, {&pose, 1}, cue.needs, {&score, 1});
    return cue.cost(score.reductions, frame_.distance_cap);
  }

 private:
  Model model_ = make_model(Shape{});
  PreparedFrame frame_;
  std::unique_ptr<Backend> backend_ = make_scalar_backend();
};

class EveryCue : public ::testing::TestWithParam<Cue> {};
INSTANTIATE_TEST_SUITE_P(Cues, EveryCue, ::testing::ValuesIn(kCues),
                         [](const auto& param) { return std::string(param.param.name); });

TEST_P(EveryCue, TruePoseScoresBetterThanWrongOnes) {
  const Camera camera = camera_from_field_of_view(320, 240, 60.0);
  const Model model = make_model(Shape{});
  for (const Pose& truth : gestures()) {
    Judge judge(camera, observe(model, truth, camera));
    const double best = judge.cost(GetParam(), truth);
    for (const Perturbation& p : perturbations()) {
      const double cost = judge.cost(GetParam(), perturbed(truth, p));
      EXPECT_GT(cost, best) << p.name << " by " << p.by;
    }
  }
}

TEST_P(EveryCue, GrowsWithTheDistanceFromTheTruth) {
  const Camera camera = camera_from_field_of_view(160, 120, 60.0);
  const Pose truth = gestures().front();
  Judge judge(camera, observe(make_model(Shape{}), truth, camera));
  double last = judge.cost(GetParam(), truth);
  for (const double away : {0.02, 0.05, 0.1, 0.15}) {
    const double cost = judge.cost(GetParam(), perturbed(truth, {"root x", 0, away}));
    EXPECT_GT(cost, last) << away;
    last = cost;
  }
}

TEST_P(EveryCue, IsFiniteAndNotNegativeOnAnyPicture) {
  const Camera camera = camera_from_field_of_view(80, 60, 60.0);
  Pose gone = gestures().front();
  gone.root.x() = 30.0;
  for (const int label : {0, 1, 2, 3, 255}) {
    for (const float distance : {0.0F, 5.0F, 20.0F}) {
      FrameFeatures seen;
      seen.labels = cv::Mat(60, 80, CV_8UC1, cv::Scalar(label));
      seen.distance = cv::Mat(60, 80, CV_32FC1, cv::Scalar(distance));
      Judge judge(camera, seen);
      for (const Pose& pose : {gestures().front(), gone}) {
        const double cost = judge.cost(GetParam(), pose);
        ASSERT_TRUE(std::isfinite(cost)) << label << " " << distance;
        ASSERT_GE(cost, 0.0);
      }
    }
  }
}

TEST_P(EveryCue, OfNothingAtAllIsFinite) {
  EXPECT_TRUE(std::isfinite(GetParam().cost(Reductions{}, 20.0)));
}

TEST(Cues, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names;
  for (const Cue& cue : kCues) {
    EXPECT_FALSE(cue.name.empty());
    EXPECT_FALSE(cue.unit.empty());
    names.insert(cue.name);
  }
  EXPECT_EQ(names.size(), kCues.size());
}

}  // namespace
}  // namespace telemime
