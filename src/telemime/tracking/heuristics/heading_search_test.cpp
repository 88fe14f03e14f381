// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/heading_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "telemime/search/shape_refine.h"
#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_scene::both_arms_seen;
using testing_scene::kDegree;
using testing_scene::particle;
using testing_scene::Scene;

constexpr int kSeeds = 60;

// Searches that are too short to move far from their start.
struct ShortSearch : Scene {
  ShortSearch() { config.turn_evaluations = config.walk_evaluations = 10; }
};

// Particles made from these parents.
Generation searched(Scene& scene, std::vector<Particle> parents, std::uint64_t seed = 1) {
  Generation generation;
  generation.parents = std::move(parents);
  const FilterContext context = scene.context(seed);
  search_heading(context, generation);
  run_searches(context, generation);
  return generation;
}

// Particles made from a heaviest parent with this torsion.
Generation turned(Scene& scene, double torsion, std::uint64_t seed) {
  Pose pose = both_arms_seen();
  pose[Angle::root_torsion] = torsion;
  return searched(scene, {particle(both_arms_seen(), 0.3), particle(pose, 0.7)}, seed);
}

TEST(HeadingSearch, AnUprightTrunkIsTurnedHalfOfTheTime) {
  ShortSearch scene;
  int came = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const std::size_t count = turned(scene, 0.0, seed).particles.size();
    ASSERT_LE(count, 1U);
    came += static_cast<int>(count);
  }
  EXPECT_NEAR(came, kSeeds / 2.0, 15);
}

TEST(HeadingSearch, ATurnedTrunkIsAlwaysTriedUpright) {
  ShortSearch scene;
  int two = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Generation generation = turned(scene, 0.6, seed);
    ASSERT_GE(generation.particles.size(), 1U);
    ASSERT_LE(generation.particles.size(), 2U);
    EXPECT_NEAR(generation.particles[0].pose[Angle::root_torsion], 0.0, 0.15);
    if (generation.particles.size() == 2) {
      ++two;
      EXPECT_GT(std::abs(generation.particles[1].pose[Angle::root_torsion] - 0.6), 0.1);
    }
  }
  EXPECT_NEAR(two, kSeeds / 2.0, 15);
}

TEST(HeadingSearch, ABentTrunkIsStraightenedAboutTheNeck) {
  ShortSearch scene;
  Pose bent = both_arms_seen();
  bent[Angle::root_roll] = 0.3;
  const Generation generation = searched(scene, {particle(bent, 1.0)});
  ASSERT_FALSE(generation.particles.empty());
  const Pose& upright = generation.particles[0].pose;
  EXPECT_LT(std::abs(upright[Angle::root_roll]), 0.1);
  const Eigen::Vector3d neck = scene.joints(bent)[Joint::neck];
  EXPECT_LT((scene.joints(upright)[Joint::neck] - neck).norm(), 0.04);
  EXPECT_GT((upright.root - bent.root).norm(), 0.08);
}

TEST(HeadingSearch, FarLeanIsTriedUprightAtItsLowerEnd) {
  ShortSearch scene;
  for (const double tilt : {0.4, -0.4}) {
    Pose leaning = both_arms_seen();
    leaning[Angle::root_tilt] = tilt;
    const Generation generation = searched(scene, {particle(leaning, 1.0)});
    ASSERT_GE(generation.particles.size(), 2U) << tilt;
    const Pose& upright = generation.particles[1].pose;
    EXPECT_LT(std::abs(upright[Angle::root_tilt]), 0.15) << tilt;
    const Eigen::Vector3d before = scene.joints(leaning)[Joint::neck];
    const Eigen::Vector3d after = scene.joints(upright)[Joint::neck];
    EXPECT_GT(tilt * (leaning.root.z() - before.z()), 0.0) << "forward is toward the camera";
    EXPECT_NEAR(after.z(), leaning.root.z(), 0.05) << tilt;
    EXPECT_LT((after / after.z() - before / before.z()).norm(), 0.05) << "the neck is seen where it was";
  }
}

TEST(HeadingSearch, ArmsStayInTheImageWhenTheTrunkTurns) {
  ShortSearch scene;  // shows both_arms_seen(), upright
  // The trunk was lost, not the arms.
  Pose lost = both_arms_seen();
  lost[Angle::root_torsion] = 0.5;
  lost = carry_arms(scene.model.body, both_arms_seen(), scene.model.body, lost, scene.limits);
  const Generation generation = searched(scene, {particle(lost, 1.0)});
  ASSERT_FALSE(generation.particles.empty());
  const JointPositions truth = scene.joints(both_arms_seen());
  const JointPositions found = scene.joints(generation.particles[0].pose);
  for (const Joint joint : {Joint::l_wrist, Joint::r_wrist, Joint::l_elbow, Joint::r_elbow}) {
    EXPECT_LT((found[joint] / found[joint].z() - truth[joint] / truth[joint].z()).norm(), 0.06);
  }
}

TEST(HeadingSearch, AWalkingPersonIsTriedFacingAhead) {
  ShortSearch scene;
  scene.heading = 0.7;
  EXPECT_NEAR(turned(scene, 0.0, 1).particles.at(0).pose[Angle::root_torsion], 0.7, 0.15);
}

TEST(HeadingSearch, AccountsForWhatItMakes) {
  Scene scene;
  scene.config.particles = 400;
  scene.config.turn_evaluations = 20;
  scene.config.walk_evaluations = 50;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Generation generation = turned(scene, 0.6, seed);
    const int by_chance = static_cast<int>(generation.particles.size()) - 1;
    EXPECT_EQ(generation.evaluations, 52 + 22 * by_chance) << "each chooses from two starts";
    for (std::size_t i = 0; i < generation.particles.size(); ++i) {
      const Particle& p = generation.particles[i];
      EXPECT_EQ(p.parent, 1) << "the heaviest";
      EXPECT_DOUBLE_EQ(p.prior, (i == 0 ? 50.0 : 20.0) / 400.0);
      EXPECT_EQ(p.origin, Origin::elsewhere);
      EXPECT_TRUE(scene.limits.contains(p.pose));
    }
  }
}

TEST(HeadingSearch, FewParticlesMeanAShorterThoroughSearch) {
  Scene scene;
  scene.config.particles = 120;
  scene.config.turn_evaluations = 20;
  scene.config.walk_evaluations = 1000;
  const Generation generation = turned(scene, 0.6, 1);
  ASSERT_FALSE(generation.particles.empty());
  EXPECT_DOUBLE_EQ(generation.particles[0].prior, 60.0 / 120.0);
}

TEST(HeadingSearch, FindsTheUprightTrunkThatTheImageShows) {
  Scene scene;
  Generation generation = turned(scene, 0.6, 2);
  std::vector<Particle> both = {generation.parents[1], generation.particles.at(0)};
  both[0].parent = both[1].parent = 0;  // both are judged by the same motion
  measure(scene.context(), both);
  EXPECT_LT(both[1].score.region(), 0.7 * both[0].score.region());
  EXPECT_GT(both[1].log_likelihood, both[0].log_likelihood);
}

}  // namespace
}  // namespace telemime
