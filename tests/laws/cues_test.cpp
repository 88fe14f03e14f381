// SPDX-License-Identifier: Apache-2.0
// Laws that hold for every built-in cue.
#include "telemime/likelihood/cues/table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "support/rendered_person.h"
#include "telemime/core/errors.h"
#include "telemime/likelihood/all.h"
#include "telemime/likelihood/testing_landmarks.h"
#include "telemime/search/two_step.h"

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

// Costs of poses on one frame by one cue, given by its position in the table.
class Judge {
 public:
  Judge(const Camera& camera, const FrameFeatures& seen) : frame_(prepare(seen, camera)) {}
  // A frame in which perfect networks have seen the pose, too.
  Judge(const Camera& camera, const Pose& truth)
      : Judge(camera, observe(make_model(Shape{}), truth, camera)) {
    frame_.landmarks = testing_landmarks::perfect_landmarks(model_.body, truth, camera);
  }
  double cost(std::size_t cue, const Pose& pose) {
    Score score;
    backend_->evaluate(frame_, model_, {&pose, 1}, kCues[cue].needs, {&score, 1});
    return score.costs[cue];
  }

 private:
  Model model_ = make_model(Shape{});
  PreparedFrame frame_;
  std::unique_ptr<Backend> backend_ = make_scalar_backend();
};

class EveryCue : public ::testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Cues, EveryCue, ::testing::Range(std::size_t{0}, kCues.size()),
                         [](const auto& param) { return std::string(kCues[param.param].name); });

// Slopes in depth say nothing about where a person is, nor about turns in the plane of the image.
bool sees(std::size_t cue, const std::string& perturbation) {
  const auto names = [&](const char* part) { return perturbation.find(part) != std::string::npos; };
  return cue != cue::kBones || names("tilt") || names("torsion") || names("flexion");
}

TEST_P(EveryCue, TruePoseScoresBetterThanWrongOnes) {
  const Camera camera = camera_from_field_of_view(320, 240, 60.0);
  for (const Pose& truth : gestures()) {
    Judge judge(camera, truth);
    const double best = judge.cost(GetParam(), truth);
    for (const Perturbation& p : perturbations()) {
      const double cost = judge.cost(GetParam(), perturbed(truth, p));
      EXPECT_GE(cost, best - 1e-9) << p.name << " by " << p.by;
      if (sees(GetParam(), p.name)) {
        EXPECT_GT(cost, best) << p.name << " by " << p.by;
      }
    }
  }
}

TEST_P(EveryCue, GrowsWithTheDistanceFromTheTruth) {
  const Camera camera = camera_from_field_of_view(160, 120, 60.0);
  const Pose truth = gestures().front();
  if (!sees(GetParam(), "root x")) {
    GTEST_SKIP() << "this cue does not see where the person is";
  }
  Judge judge(camera, truth);
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

TEST_P(EveryCue, IsFiniteWithoutAnyCounts) {
  const PreparedFrame frame;
  const Model model = make_model(Shape{});
  const Kinematics kinematics = forward_kinematics(model.body, Pose{});
  const Reductions nothing;
  const CueInput input{.frame = frame, .model = model, .reductions = nothing, .kinematics = &kinematics};
  EXPECT_TRUE(std::isfinite(kCues[GetParam()].cost(input)));
}

TEST_P(EveryCue, HasAWeightAScaleAndASentence) {
  const Cue& cue = kCues[GetParam()];
  EXPECT_FALSE(cue.what.empty());
  EXPECT_GE(cue.region_step, 0.0);
  EXPECT_GT(cue.edge_step, 0.0);
  EXPECT_GT(cue.scale, 0.0);
}

// A cue from the pose alone: the height of the left wrist above the root, m.
double wrist_height(const CueInput& input) {
  const JointPositions& joints = input.kinematics->joints;
  return std::max(0.0, joints[Joint::root].y() - joints[Joint::l_wrist].y());
}
constexpr Cue kWristCue = {.name = "wrist",
                           .what = "height of the left wrist above the root",
                           .needs_kinematics = true,
                           .edge_step = 0.5,
                           .scale = 0.1,
                           .sigma = 0.2,
                           .cost = wrist_height};

TEST(CueTable, AddedCueIsScoredByEveryBackend) {
  CueTable cues;
  cues.add(kWristCue);
  const Camera camera = camera_from_field_of_view(80, 60, 60.0);
  const Model model = make_model(Shape{});
  const Pose pose = gestures().front();
  const PreparedFrame frame = prepare(observe(model, pose, camera), camera);
  const Kinematics kinematics = forward_kinematics(model.body, pose);
  const double height =
      wrist_height({.frame = frame, .model = model, .reductions = {}, .kinematics = &kinematics});
  for (const char* name : {"scalar", "simd"}) {
    Score score;
    make_backend(name, {.cues = cues})->evaluate(frame, model, {&pose, 1}, cues.needs(), {&score, 1});
    EXPECT_EQ(score.costs[kCues.size()], height) << name;
    Score without;
    make_backend(name)->evaluate(frame, model, {&pose, 1}, Reduction::all, {&without, 1});
    EXPECT_EQ(score.region(), without.region()) << name;
    EXPECT_EQ(score.contour(), without.contour()) << name;
  }
}

TEST(CueTable, AddedCueCountsInTheObjective) {
  CueTable cues;
  cues.add(kWristCue);
  const Camera camera = camera_from_field_of_view(80, 60, 60.0);
  const Model model = make_model(Shape{});
  const JointLimits limits = anatomical_limits();
  const Pose pose = gestures().front();
  const PreparedFrame frame = prepare(observe(model, pose, camera), camera);
  const auto cost = [&](const CueTable& table) {
    const auto backend = make_scalar_backend(table);
    Objective objective(*backend, frame, model, limits);
    return objective(pose, with_cues(RegistrationConfig{}, table).edge);
  };
  const auto backend = make_scalar_backend(cues);
  const double wrist =
      Objective(*backend, frame, model, limits).score(pose, cues.needs()).costs[kCues.size()];
  ASSERT_GT(wrist, 0.0);
  EXPECT_NEAR(cost(cues) - cost(CueTable{}), 0.5 * wrist / 0.1, 1e-12);
  cues.enable(kCues.size(), false);
  EXPECT_EQ(cost(cues), cost(CueTable{})) << "a disabled cue does not count";
}

TEST(CueTable, CueWithoutEvidenceDoesNotCount) {
  const Camera camera = camera_from_field_of_view(80, 60, 60.0);
  const Model model = make_model(Shape{});
  const Pose pose = gestures().front();
  PreparedFrame frame = prepare(observe(model, gestures().back(), camera), camera);
  EXPECT_EQ(reliability_of(kCues[cue::kLandmarks], frame), 0.0) << "no network has looked";
  frame.has_colours = false;
  EXPECT_EQ(reliability_of(kCues[cue::kRegion], frame), 0.0) << "no colours are known";
  const auto backend = make_scalar_backend();
  CueValues only_regions{};
  only_regions[cue::kRegion] = 1.0;
  Score score;
  backend->evaluate(frame, model, {&pose, 1}, Reduction::all, {&score, 1});
  ASSERT_GT(score.region(), 0.1);
  EXPECT_EQ(add_cue_costs(0.0, *backend, frame, only_regions, score), 0.0);
  frame.has_colours = true;
  EXPECT_GT(add_cue_costs(0.0, *backend, frame, only_regions, score), 0.1);
}

TEST(CueTable, RefusesCuesThatCannotWork) {
  CueTable cues;
  Cue bad = kWristCue;
  bad.name = "regions";
  EXPECT_THROW(cues.add(bad), Error) << "a name that is taken";
  bad = kWristCue;
  bad.cost = nullptr;
  EXPECT_THROW(cues.add(bad), Error);
  bad = kWristCue;
  bad.sigma = 0.0;
  EXPECT_THROW(cues.add(bad), Error);
  EXPECT_THROW(CueTable(std::array{kWristCue}), Error) << "the built-in cues are missing";
  const std::vector<std::string> names = {"a", "b", "c", "d", "e"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    Cue one = kWristCue;
    one.name = names[i];
    if (kCues.size() + i < kMostCues) {
      cues.add(one);
    } else {
      EXPECT_THROW(cues.add(one), Error) << "the table is full";
    }
  }
}

TEST(Cues, HaveUniqueNames) {
  std::set<std::string_view> names;
  for (const Cue& cue : kCues) {
    EXPECT_FALSE(cue.name.empty());
    names.insert(cue.name);
  }
  EXPECT_EQ(names.size(), kCues.size());
}

}  // namespace
}  // namespace telemime
