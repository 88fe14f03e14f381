// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"
#include "telemime/outputs/all.h"
#include "telemime/outputs/bap/profile.h"
#include "telemime/outputs/testing_bap.h"
#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

using namespace testing_bap;

constexpr double kDegree = std::numbers::pi / 180.0;

/// Largest difference of the segments' orientations and of the joints' places (m) between two poses.
double difference(const Body& body, const Pose& a, const Pose& b) {
  const Kinematics ka = forward_kinematics(body, a);
  const Kinematics kb = forward_kinematics(body, b);
  double largest = 0.0;
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    largest = std::max(
        largest,
        (ka.camera_from_segment[s].matrix() - kb.camera_from_segment[s].matrix()).cwiseAbs().maxCoeff());
  }
  return largest;
}

int value_of(const BapProfile& profile, const Pose& pose, int id) {
  const auto ids = bap_ids(profile);
  const auto* const found = std::find(ids.begin(), ids.end(), id);
  EXPECT_NE(found, ids.end()) << "profile " << profile.name << " does not send " << id;
  return encode_bap(profile, pose, {})[static_cast<std::size_t>(found - ids.begin())];
}

TEST(BapTable, HasAllIdsInOrderWithUniqueNames) {
  std::set<std::string_view> names;
  int id = 0;
  for (const Bap& entry : bap_table()) {
    EXPECT_EQ(entry.id, ++id);
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    for (const SignedAxis axis : {entry.visage, entry.greta}) {
      EXPECT_TRUE(axis.axis >= 0 && axis.axis <= 2 && std::abs(axis.sign) == 1) << entry.name;
    }
    EXPECT_EQ(entry.kind == BapKind::translation, id >= 181 && id <= 183);
  }
  EXPECT_EQ(id, kBapCount);
  EXPECT_THROW(bap(0), Error);
  EXPECT_THROW(bap(187), Error);
}

TEST(BapTable, NamesOfTheThesis) {
  EXPECT_EQ(bap(32).name, "l_shoulder_flexion");
  EXPECT_EQ(bap(47).name, "r_wrist_twisting");
  EXPECT_EQ(bap(48).name, "skullbase_roll");
  EXPECT_EQ(bap(121).name, "vl5_torsion");
}

TEST(BapProfile, SendsTheTwentyAnglesAboutTheirAxes) {
  for (const BapProfile& profile : bap_profiles()) {
    const auto ids = bap_ids(profile);
    EXPECT_EQ(std::set<int>(ids.begin(), ids.end()).size(), kAngleCount);
    for (const BapJoint& joint : {profile.trunk, profile.neck, profile.l_shoulder, profile.r_shoulder,
                                  profile.l_wrist, profile.r_wrist}) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ((bap(joint.id[static_cast<std::size_t>(axis)]).*profile.sign).axis, axis);
      }
    }
  }
}

TEST(BapProfile, DecodingIsTheInverseAsRotations) {
  const Body body = make_body(Shape{});
  for (const BapProfile& profile : bap_profiles()) {
    Random random(7);
    BapValues last{};
    for (int n = 0; n < 300; ++n) {
      const Pose pose = testing_motion::random_pose(anatomical_limits(), random);
      last = encode_bap(profile, pose, last);
      EXPECT_LT(difference(body, decode_bap(profile, last, pose), pose), 3e-4) << profile.name;
    }
  }
}

TEST(BapProfile, DecodesNearTheAnglesThatWereEncoded) {
  Random random(8);
  for (const BapProfile& profile : bap_profiles()) {
    for (int n = 0; n < 100; ++n) {
      Pose pose = testing_motion::random_pose(reference_limits(), random);
      pose[Angle::l_shoulder_flexion] = random.uniform(-1.2, 0.4);  // away from the singular -90 degrees
      pose[Angle::r_shoulder_flexion] = random.uniform(-1.2, 0.4);
      const Pose decoded = decode_bap(profile, encode_bap(profile, pose, {}), pose);
      for (std::size_t a = 0; a < kAngleCount; ++a) {
        EXPECT_NEAR(decoded.angles[a], pose.angles[a], 5e-4) << profile.name << " " << kAngleNames[a];
      }
    }
  }
}

TEST(BapProfile, SignsAndUnits) {
  Pose pose;
  pose[Angle::l_shoulder_flexion] = -90.0 * kDegree;  // arm forward
  pose[Angle::r_elbow_flexion] = -60.0 * kDegree;     // forearm forward
  pose[Angle::r_shoulder_abduct] = -30.0 * kDegree;   // arm outward
  const int right_angle = 157080;
  EXPECT_EQ(value_of(bap_profile("iso"), pose, 32), right_angle);
  EXPECT_EQ(value_of(bap_profile("iso"), pose, 39), 104720);
  EXPECT_EQ(value_of(bap_profile("iso"), pose, 35), -52360);
  EXPECT_EQ(value_of(bap_profile("greta"), pose, 32), -right_angle);
  EXPECT_EQ(value_of(bap_profile("greta"), pose, 35), -52360);
  EXPECT_EQ(value_of(bap_profile("vreng-3.2"), pose, 32), 50000);  // 1e5 units are half a turn
  EXPECT_EQ(value_of(bap_profile("vreng-3.2"), pose, 39), 33333);
}

TEST(BapProfile, SingleAnglesOfTheTrunkPassUnchanged) {
  Pose pose;
  pose[Angle::root_torsion] = 0.3;
  EXPECT_EQ(value_of(bap_profile("iso"), pose, 121), 30000);
  EXPECT_EQ(value_of(bap_profile("vreng-3.1"), pose, 2), 30000);
  pose = {};
  pose[Angle::neck_tilt] = 0.1;
  EXPECT_EQ(value_of(bap_profile("iso"), pose, 50), -10000);
  EXPECT_EQ(value_of(bap_profile("greta"), pose, 50), 10000);
}

TEST(BapProfile, AliasAndUnknownName) {
  EXPECT_EQ(&bap_profile("visage"), &bap_profile("iso"));
  EXPECT_THROW(bap_profile("poser"), Error);
  EXPECT_THROW(make_bap_encoder("poser"), Error);
}

TEST(BapFile, ReadsBackWhatItWroteForEveryProfile) {
  const StreamHeader header = testing_motion::header();
  auto frames = testing_motion::gesture(header, 30);
  testing_motion::lose(frames, 3);
  for (const BapProfile& profile : bap_profiles()) {
    const BapFile file =
        parse_bap(testing_motion::encode_all(*make_bap_encoder(profile.name), header, frames));
    EXPECT_EQ(file.version, profile.version);
    EXPECT_EQ(file.name, "motion.bap");
    EXPECT_EQ(file.fps, 25.0);
    EXPECT_EQ(file.stated_frames, 30);
    ASSERT_EQ(file.frames.size(), frames.size());
    BapValues values{};
    for (std::size_t f = 0; f < frames.size(); ++f) {
      EXPECT_EQ(file.frames[f].number, frames[f].frame);
      EXPECT_EQ(file.frames[f].mask_length, static_cast<std::size_t>(profile.mask_length));
      values = values_of(profile, file.frames[f], values);
      const Pose decoded = decode_bap(profile, values, frames[f].pose);
      EXPECT_LT(difference(header.body, decoded, frames[f].pose), 3e-4);
    }
  }
}

}  // namespace
}  // namespace telemime
