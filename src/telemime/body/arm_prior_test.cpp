// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/arm_prior.h"

#include <gtest/gtest.h>

#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

// Rarity of a pose whose arms are mirror images of each other: directions from shoulder to elbow and from
// elbow to wrist of the left arm, x outward, y up, z the way the chest faces.
double rarity_of(const Eigen::Vector3d& upper, const Eigen::Vector3d& fore) {
  Kinematics k = forward_kinematics(make_body({}), Pose{});
  const Eigen::Matrix3d chest = k[Segment::chest].linear();
  const auto place = [&](Joint shoulder, Joint elbow, Joint wrist, double side) {
    const Eigen::Vector3d mirror(side, 1.0, 1.0);
    k.joints[elbow] = k.joints[shoulder] + 0.27 * (chest * upper.normalized().cwiseProduct(mirror));
    k.joints[wrist] = k.joints[elbow] + 0.25 * (chest * fore.normalized().cwiseProduct(mirror));
  };
  place(Joint::l_shoulder, Joint::l_elbow, Joint::l_wrist, 1.0);
  place(Joint::r_shoulder, Joint::r_elbow, Joint::r_wrist, -1.0);
  return arm_rarity(k);
}

TEST(ArmPrior, HandsInTheLapAreNotRare) {
  EXPECT_LT(rarity_of({0.1, -1.0, 0.1}, {-0.3, -0.1, 1.0}), 5.0);
  EXPECT_LT(rarity_of({0.1, -1.0, 0.0}, {0.0, -1.0, 0.2}), 8.0);
}

TEST(ArmPrior, MirrorInDepthIsRarer) {
  const Eigen::Vector3d upper(0.2, -0.7, 0.7);
  const Eigen::Vector3d fore(-0.5, 0.0, 1.0);
  const Eigen::Vector3d back(1.0, 1.0, -1.0);
  EXPECT_GT(rarity_of(upper.cwiseProduct(back), fore.cwiseProduct(back)), 4.0 * rarity_of(upper, fore));
}

TEST(ArmPrior, ExchangedSidesAreEquallyRare) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Pose pose = testing_poses::random_pose(anatomical_limits(), random);
    const Kinematics k = forward_kinematics(make_body({}), pose);
    const Eigen::Isometry3d chest = k[Segment::chest];
    Kinematics mirrored = k;
    const auto mirror = [&](Joint from, Joint to) {
      const Eigen::Vector3d p = chest.inverse() * k.joints[from];
      mirrored.joints[to] = chest * Eigen::Vector3d(-p.x(), p.y(), p.z());
    };
    for (const auto& [l, r] :
         {std::pair(Joint::l_shoulder, Joint::r_shoulder), std::pair(Joint::l_elbow, Joint::r_elbow),
          std::pair(Joint::l_wrist, Joint::r_wrist)}) {
      mirror(l, r);
      mirror(r, l);
    }
    EXPECT_NEAR(arm_rarity(k), arm_rarity(mirrored), 1e-9 * arm_rarity(k));
  }
}

TEST(ArmPrior, PlaceOfThePersonDoesNotMatter) {
  Random random(4);
  Pose pose = testing_poses::bent_pose(anatomical_limits(), random);
  const double here = arm_rarity(forward_kinematics(make_body({}), pose));
  pose.root += Eigen::Vector3d(0.4, -0.2, 1.0);
  pose[Angle::root_torsion] += 0.7;
  EXPECT_NEAR(arm_rarity(forward_kinematics(make_body({}), pose)), here, 1e-9);
}

}  // namespace
}  // namespace telemime
