// SPDX-License-Identifier: Apache-2.0
// Registration on frames rendered from the model.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/rendered_person.h"
#include "telemime/likelihood/all.h"
#include "telemime/search/two_step.h"

namespace telemime {
namespace {

using support::gestures;
using support::observe;
using testing_poses::kDegree;

// Inputs of one search; the frame shows the true pose.
class Search {
 public:
  explicit Search(const Pose& truth)
      : truth_(truth), frame_(prepare(observe(model_, truth, camera_), camera_)) {}

  RegistrationResult from(const Pose& start, const RegistrationConfig& config, std::uint64_t seed = 1) {
    Objective objective(*backend_, frame_, model_, limits_,
                        predict_ ? prior_at(model_.body, start) : Prior{});
    Random random(seed);
    const RegistrationResult result = register_pose(objective, start, config, random);
    evaluations_ = objective.evaluations();
    return result;
  }

  // Mean distance (m) of elbows and wrists from the truth: in space, or across the viewing ray only.
  double error(const Pose& pose, bool across) const {
    const JointPositions a = forward_kinematics(model_.body, pose).joints;
    const JointPositions b = forward_kinematics(model_.body, truth_).joints;
    double sum = 0.0;
    for (const Joint j : {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist, Joint::r_wrist}) {
      const Eigen::Vector3d there = across ? Eigen::Vector3d(a[j] * (b[j].z() / a[j].z())) : a[j];
      sum += 0.25 * (there - b[j]).norm();
    }
    return sum;
  }

  // Distance (m) of the left wrist from the truth across the viewing ray.
  double left_wrist_error(const Pose& pose) const {
    const Eigen::Vector3d a = forward_kinematics(model_.body, pose).joints[Joint::l_wrist];
    const Eigen::Vector3d b = forward_kinematics(model_.body, truth_).joints[Joint::l_wrist];
    return (a * (b.z() / a.z()) - b).norm();
  }

  int evaluations() const { return evaluations_; }
  /// Without this call the start is also the prediction.
  void predict_nothing() { predict_ = false; }
  void set_limits(const JointLimits& limits) { limits_ = limits; }
  const JointLimits& limits() const { return limits_; }

 private:
  Model model_ = make_model(Shape{});
  Camera camera_ = camera_from_field_of_view(160, 120, 60.0);
  JointLimits limits_ = anatomical_limits();
  Pose truth_;
  PreparedFrame frame_;
  std::unique_ptr<Backend> backend_ = make_backend("simd");
  int evaluations_ = 0;
  bool predict_ = true;
};

// A pose a few frames of motion away.
Pose moved(const Pose& pose, double share, Random& random) {
  Pose away = pose;
  away.root +=
      Eigen::Vector3d(random.normal(0, 0.01), random.normal(0, 0.01), random.normal(0, 0.02)) * share;
  for (std::size_t i = 0; i < kAngleCount; ++i) {
    const bool arm = i >= static_cast<std::size_t>(Angle::l_shoulder_flexion);
    away.angles[i] += share * random.normal(0, arm ? 8 * kDegree : 2 * kDegree);
  }
  return anatomical_limits().clamp(away);
}

TEST(Registration, ComesBackToTheTruth) {
  Random random(1);
  double before = 0.0;
  double across = 0.0;
  double space = 0.0;
  int searches = 0;
  for (const Pose& truth : gestures()) {
    Search search(truth);
    for (int i = 0; i < 2; ++i, ++searches) {
      const Pose start = moved(truth, 1.0, random);
      const RegistrationResult found = search.from(start, RegistrationConfig{});
      before += search.error(start, false);
      across += search.error(found.pose, true);
      space += search.error(found.pose, false);
      EXPECT_LT(found.score.region(), 0.15);
      EXPECT_LT(found.score.contour(), 2.0);
    }
  }
  EXPECT_LT(across / searches, 0.030) << "m across the view";
  EXPECT_LT(space / searches, 0.7 * before / searches) << "m in space";
  RecordProperty("across_mm", std::to_string(1000 * across / searches));
  RecordProperty("space_mm", std::to_string(1000 * space / searches));
}

TEST(Registration, StaysInsideTheLimits) {
  Random random(2);
  for (const JointLimits& limits : {anatomical_limits(), reference_limits()}) {
    for (const Pose& truth : gestures()) {
      Search search(truth);
      search.set_limits(limits);
      Pose start = moved(truth, 2.0, random);
      start[Angle::l_elbow_flexion] = -3.0;  // beyond every limit
      start[Angle::neck_roll] = 1.5;
      for (const bool blocks : {true, false}) {
        RegistrationConfig config;
        config.iterations = 200;
        config.blocks = blocks;
        EXPECT_TRUE(limits.contains(search.from(start, config).pose)) << limits.name << " " << blocks;
      }
    }
  }
}

TEST(Registration, SpendsNoMoreThanItsBudget) {
  const Pose truth = gestures()[1];
  Random random(3);
  const Pose start = moved(truth, 1.0, random);
  Search search(truth);
  for (const auto& [name, method] : kMethodNames) {
    for (const bool blocks : {true, false}) {
      for (const int iterations : {1, 2, 5, 30, 100, 400}) {
        RegistrationConfig config;
        config.method = method;
        config.blocks = blocks;
        config.iterations = iterations;
        const RegistrationResult found = search.from(start, config);
        const std::string what =
            std::string(name) + (blocks ? " blocks " : " whole ") + std::to_string(iterations);
        // One evaluation scores the result; a budget of 1 still evaluates the start once.
        EXPECT_LE(search.evaluations(), std::max(2, iterations)) << what;
        EXPECT_EQ(found.region_evaluations + found.edge_evaluations + 1, search.evaluations()) << what;
        EXPECT_TRUE(iterations < 100 || found.converged || search.evaluations() > iterations / 2) << what;
      }
    }
  }
}

TEST(Registration, MethodsTakeTheStepsOfTheirName) {
  const Pose truth = gestures()[0];
  Random random(4);
  const Pose start = moved(truth, 1.0, random);
  Search search(truth);
  const auto run = [&](Method method) {
    RegistrationConfig config;
    config.method = method;
    config.iterations = 300;
    return search.from(start, config);
  };
  const RegistrationResult regions = run(Method::regions);
  EXPECT_GT(regions.region_evaluations, 100);
  EXPECT_EQ(regions.edge_evaluations, 0);
  const RegistrationResult edges = run(Method::edges);
  EXPECT_EQ(edges.region_evaluations, 0);
  EXPECT_GT(edges.edge_evaluations, 100);
  const RegistrationResult both = run(Method::two_step);
  EXPECT_GT(both.region_evaluations, 100);
  EXPECT_GT(both.edge_evaluations, 50);
}

TEST(Registration, EveryMethodGetsNearerToThePicture) {
  const Pose truth = gestures()[2];
  Random random(5);
  const Pose start = moved(truth, 1.0, random);
  Search search(truth);
  for (RegistrationConfig config : {RegistrationConfig{}, reference_registration()}) {
    for (const auto& [name, method] : kMethodNames) {
      config.method = method;
      config.iterations = 600;
      const RegistrationResult found = search.from(start, config);
      RegistrationConfig none = config;
      none.iterations = 1;
      const RegistrationResult there = search.from(start, none);
      if (method != Method::edges) {
        EXPECT_LT(found.score.region(), there.score.region()) << name << config.blocks;
      }
      EXPECT_LT(found.score.contour(), there.score.contour()) << name << config.blocks;
    }
  }
}

TEST(Registration, SameSeedSameResult) {
  const Pose truth = gestures()[3];
  Random random(6);
  const Pose start = moved(truth, 1.0, random);
  Search search(truth);
  const RegistrationResult a = search.from(start, RegistrationConfig{}, 11);
  const RegistrationResult b = search.from(start, RegistrationConfig{}, 11);
  EXPECT_EQ(a.pose.vector(), b.pose.vector());
  EXPECT_EQ(a.score.region(), b.score.region());
  EXPECT_EQ(a.region_evaluations, b.region_evaluations);
}

// Images hardly show where the head is turned: a search that always began on the same side would turn it a
// little farther in each frame.
TEST(Registration, ANeckThatMovedIsNotLeftTurnedToOneSide) {
  Random random(3);
  int searches = 0;
  int left = 0;
  for (const Pose& truth : gestures()) {
    Search search(truth);
    for (int i = 0; i < 8; ++i) {
      Pose start = moved(truth, 0.5, random);
      start[Angle::neck_torsion] = truth[Angle::neck_torsion];
      const double turned =
          search.from(start, RegistrationConfig{}, random.bits()).pose[Angle::neck_torsion] -
          truth[Angle::neck_torsion];
      if (std::abs(turned) > 0.2 * kDegree) {
        ++searches;
        left += turned > 0.0 ? 1 : 0;
      }
    }
  }
  ASSERT_GT(searches, 20);
  EXPECT_NEAR(static_cast<double>(left) / searches, 0.5, 0.25) << left << " of " << searches;
}

TEST(Registration, FindsAnArmAgainThatIsFarAway) {
  const Pose truth = gestures()[0];
  Search search(truth);
  Pose start = truth;
  set_arm_angles(start, Side::left, {-130 * kDegree, 0, 10 * kDegree, -40 * kDegree});
  ASSERT_GT(search.error(start, true), 0.1);
  search.predict_nothing();
  RegistrationConfig config;
  config.proposals.arms = 200;
  config.iterations = 2000;
  EXPECT_LT(search.error(search.from(start, config).pose, true), 0.04);
}

TEST(Registration, LostForearmIsBackInAThirdOfASecond) {
  int cases = 0;
  int back = 0;
  int back_without = 0;
  for (const double bend : {-100.0, -120.0}) {
    for (const double twist : {-40.0, 40.0}) {
      Pose truth = support::seated({-20 * kDegree, twist * kDegree, 15 * kDegree, bend * kDegree},
                                   {-20 * kDegree, 0, -15 * kDegree, bend * kDegree});
      truth.root.y() += 0.15;
      truth = anatomical_limits().clamp(truth);
      Search search(truth);
      for (const double lost : {-5.0, -130.0}) {
        Pose start = truth;
        ArmAngles arm = arm_angles(truth, Side::left);
        arm.twisting = -arm.twisting;
        arm.elbow = lost * kDegree;
        set_arm_angles(start, Side::left, arm);
        // Each case is run with several seeds.
        const auto found = [&](const RegistrationConfig& config, std::uint64_t seed) {
          Pose pose = anatomical_limits().clamp(start);
          for (std::uint64_t frame = 0; frame < 8; ++frame) {
            pose = search.from(pose, config, seed + frame).pose;
          }
          return search.left_wrist_error(pose) < 0.06;
        };
        RegistrationConfig without;
        without.proposals = no_proposals();
        for (const std::uint64_t seed : {10, 100, 200, 300}) {
          ++cases;
          back += found(RegistrationConfig{}, seed) ? 1 : 0;
          back_without += found(without, seed) ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GE(back, cases * 7 / 8) << "of " << cases;
  EXPECT_LT(back_without, back - cases / 4) << "the cases are too easy to show anything";
}

class ProposalTest : public ::testing::Test {
 protected:
  PreparedFrame frame_of(const Pose& truth) const {
    return prepare(observe(model_, truth, camera_), camera_);
  }
  Objective objective(const PreparedFrame& frame) const { return {*backend_, frame, model_, limits_}; }

  const Model model_ = make_model(Shape{});
  const Camera camera_ = camera_from_field_of_view(160, 120, 60.0);
  const JointLimits limits_ = anatomical_limits();
  const std::unique_ptr<Backend> backend_ = make_scalar_backend();
  const RegistrationConfig config_{};
};

TEST_F(ProposalTest, ATrunkIsHalfAsBentOnlyWhereThatFits) {
  const Pose upright = gestures()[0];
  Pose bent = upright;
  bent[Angle::root_roll] += 14 * kDegree;
  bent.root += forward_kinematics(model_.body, upright).joints[Joint::neck] -
               forward_kinematics(model_.body, bent).joints[Joint::neck];
  for (const Side side : {Side::left, Side::right}) {
    bent = with_wrist(model_.body, bent, side, arm_target(model_.body, upright, side), limits_);
  }
  const auto proposed = [&](const Pose& truth, const Pose& start) {
    const PreparedFrame frame = frame_of(truth);
    Objective search = objective(frame);
    return propose_upright(search, start, config_.region, config_.simplex_factor, 0);
  };
  EXPECT_EQ(proposed(bent, bent).vector(), bent.vector());
  const Pose back = proposed(upright, bent);
  EXPECT_NEAR(back[Angle::root_roll], 0.5 * bent[Angle::root_roll], 1e-9);
  const JointPositions before = forward_kinematics(model_.body, bent).joints;
  const JointPositions after = forward_kinematics(model_.body, back).joints;
  for (const Joint j : {Joint::neck, Joint::l_wrist, Joint::r_wrist}) {
    EXPECT_LT((before[j] - after[j]).norm(), 0.02) << kJointNames[static_cast<std::size_t>(j)];
  }
}

TEST_F(ProposalTest, ATrunkIsTriedUprightWithinItsEvaluations) {
  Pose bent = gestures()[0];
  bent[Angle::root_torsion] += 20 * kDegree;
  const PreparedFrame frame = frame_of(gestures()[0]);
  for (const int evaluations : {0, 1, 7, 20, 60, 200}) {
    Objective search = objective(frame);
    const Pose found = propose_upright(search, bent, config_.region, config_.simplex_factor, evaluations);
    EXPECT_LE(search.evaluations(), evaluations + 2) << evaluations;
    EXPECT_NEAR(found[Angle::root_torsion], 10 * kDegree, 1e-9) << evaluations;
  }
}

TEST_F(ProposalTest, OneArmAtATimeTakesBothInTurn) {
  const PreparedFrame frame = frame_of(gestures()[1]);
  const Pose start = gestures()[0];
  int left = 0;
  int right = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const auto proposed = [&] {
      Objective search = objective(frame);
      Random random(seed);
      const Pose pose = propose_arms(search, start, config_.region, config_.proposals, false, 1.5, random);
      EXPECT_LE(search.evaluations(), config_.proposals.evaluations() + 1);
      return pose;
    };
    const Pose pose = proposed();
    EXPECT_EQ(pose.vector(), proposed().vector());
    const bool l = arm_angles(pose, Side::left).elbow != arm_angles(start, Side::left).elbow;
    const bool r = arm_angles(pose, Side::right).elbow != arm_angles(start, Side::right).elbow;
    EXPECT_FALSE(l && r);
    left += l ? 1 : 0;
    right += r ? 1 : 0;
  }
  EXPECT_GT(left, 0);
  EXPECT_GT(right, 0);
}

TEST(Registration, WorseProposalsLeaveThePoseAlone) {
  const Pose truth = gestures()[0];
  Search search(truth);
  RegistrationConfig still;
  still.region_share = 1.0;
  still.proposals.margin = 10.0;
  RegistrationConfig none = still;
  none.proposals = no_proposals();
  // With a margin that no proposal reaches, only the present arm is searched further.
  EXPECT_LT(search.error(search.from(truth, still).pose, true), 0.02);
  EXPECT_LT(search.error(search.from(truth, none).pose, true), 0.02);
}

TEST(Registration, OnAnEmptyPictureGivesAPoseAllTheSame) {
  const Model model = make_model(Shape{});
  const Camera camera = camera_from_field_of_view(160, 120, 60.0);
  Pose gone;
  gone.root.x() = 50;
  const PreparedFrame frame = prepare(observe(model, gone, camera), camera);
  const auto backend = make_scalar_backend();
  const JointLimits limits = anatomical_limits();
  Objective objective(*backend, frame, model, limits);
  Random random(7);
  RegistrationConfig config;
  config.iterations = 200;
  const RegistrationResult found = register_pose(objective, gestures()[0], config, random);
  EXPECT_TRUE(found.pose.vector().allFinite());
  EXPECT_TRUE(limits.contains(found.pose));
  EXPECT_GT(found.score.region(), 0.3);
}

}  // namespace
}  // namespace telemime
