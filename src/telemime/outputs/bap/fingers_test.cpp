// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/bap/fingers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "telemime/body/rotations.h"
#include "telemime/outputs/all.h"
#include "telemime/outputs/testing_bap.h"
#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

int id_named(const std::string& name) {
  const auto table = bap_table();
  const auto found = std::find_if(table.begin(), table.end(), [&](const Bap& b) { return b.name == name; });
  EXPECT_NE(found, table.end()) << name;
  return found->id;
}

int value_of(const BapProfile& profile, const HandMotions& hands, const std::string& name) {
  const auto& ids = finger_bap_ids();
  const auto* const found = std::find(ids.begin(), ids.end(), id_named(name));
  EXPECT_NE(found, ids.end()) << name;
  return encode_bap_fingers(profile, hands, {})[static_cast<std::size_t>(found - ids.begin())];
}

HandMotions flat_hands() {
  HandMotions hands;
  for (HandMotion& hand : hands) {
    hand.angles = {};
  }
  return hands;
}

TEST(BapFingers, TheTableHasTheNamesOfTheIds) {
  EXPECT_TRUE(std::is_sorted(finger_bap_ids().begin(), finger_bap_ids().end()));
  for (const int id : finger_bap_ids()) {
    const std::string name(bap(id).name);
    EXPECT_EQ(name.find('0'), std::string::npos) << name;
    EXPECT_NE(name.find_first_of("123"), std::string::npos) << name;
  }
  for (const char* const name : {"l_thumb1_flexion", "r_thumb3_flexion", "l_pinky1_pivot", "r_index2_flexion",
                                 "l_ring1_twisting", "r_middle3_flexion"}) {
    EXPECT_TRUE(std::binary_search(finger_bap_ids().begin(), finger_bap_ids().end(), id_named(name))) << name;
  }
}

TEST(BapFingers, FlatHandsAreTheNeutralPosture) {
  for (const BapProfile& profile : bap_profiles()) {
    EXPECT_EQ(encode_bap_fingers(profile, flat_hands(), {}), FingerBapValues{}) << profile.name;
  }
}

TEST(BapFingers, BendingIsPositiveFlexionOfBothHands) {
  HandMotions hands = flat_hands();
  for (HandMotion& hand : hands) {
    hand.angles[kFirstFingerAngle[1]] = 0.5;      // index_mcp
    hand.angles[kFirstFingerAngle[1] + 2] = 0.6;  // index_pip, and two thirds of it in the last joint
    hand.angles[3] = 0.3;                         // thumb_ip
  }
  const BapProfile& iso = bap_profile("iso");
  for (const std::string side : {"l_", "r_"}) {
    EXPECT_EQ(value_of(iso, hands, side + "index1_flexion"), 50000) << side;
    EXPECT_EQ(value_of(iso, hands, side + "index2_flexion"), 60000) << side;
    EXPECT_EQ(value_of(iso, hands, side + "index3_flexion"), 40000) << side;
    EXPECT_EQ(value_of(iso, hands, side + "thumb3_flexion"), 30000) << side;
    EXPECT_EQ(value_of(iso, hands, side + "middle1_flexion"), 0) << side;
  }
  // Greta turns both hands about the same axis to the front: the left fingers bend to the right.
  EXPECT_EQ(value_of(bap_profile("greta"), hands, "l_index1_flexion"), -50000);
  EXPECT_EQ(value_of(bap_profile("greta"), hands, "r_index1_flexion"), 50000);
}

TEST(BapFingers, SpreadTurnsTheFirstJointAside) {
  HandMotions hands = flat_hands();
  for (HandMotion& hand : hands) {
    hand.angles[kFirstFingerAngle[1] + 1] = 0.2;  // index_spread, toward the thumb
  }
  // With the palms to the front, the left thumb is on the left and the right one on the right.
  EXPECT_EQ(value_of(bap_profile("iso"), hands, "l_index1_pivot"), 20000);
  EXPECT_EQ(value_of(bap_profile("iso"), hands, "r_index1_pivot"), -20000);
}

// What a player does with the values, written from the table of docs/formats.md.
TEST(BapFingers, ThePlayerTurnsFirstJointsAsTheModel) {
  const Body body = make_body(Shape{});
  Random random(9);
  for (const BapProfile& profile : bap_profiles()) {
    FingerBapValues values{};
    for (int n = 0; n < 50; ++n) {
      const HandMotions hands = testing_motion::random_hands(body, Pose{}, random);
      values = encode_bap_fingers(profile, hands, values);
      const auto& ids = finger_bap_ids();
      for (const Side side : {Side::left, Side::right}) {
        const auto model = finger_rotations(hands[static_cast<std::size_t>(side)].angles, side);
        const std::array<std::string, kFingerCount> names = {"thumb1", "index1", "middle1", "ring1",
                                                             "pinky1"};
        for (std::size_t f = 0; f < kFingerCount; ++f) {
          EulerAngles about{};  // x, y, z
          for (const char* const what : {"_flexion", "_pivot", "_twisting"}) {
            const int id = id_named((side == Side::left ? "l_" : "r_") + names[f] + what);
            const SignedAxis axis = bap(id).*profile.sign;
            const auto place = static_cast<std::size_t>(std::find(ids.begin(), ids.end(), id) - ids.begin());
            about.at(static_cast<std::size_t>(axis.axis)) =
                axis.sign * values[place] / profile.units_per_radian;
          }
          const bool greta = profile.name == "greta";
          const Eigen::Matrix3d player =
              greta ? Eigen::Matrix3d(rotation_z(about[2]) * rotation_y(about[1]) * rotation_x(about[0]))
                    : Eigen::Matrix3d(rotation_x(about[0]) * rotation_z(about[2]) * rotation_y(about[1]));
          const Eigen::Matrix3d forward =
              rotation_y(greta ? 0.0 : (side == Side::left ? 1.0 : -1.0) * std::numbers::pi / 2.0);
          EXPECT_LT((forward.transpose() * player * forward - model[f][0]).norm(), 1e-4)
              << profile.name << names[f];
        }
      }
    }
  }
}

TEST(BapFingers, TheFileHasThemWhereHandsAreTracked) {
  StreamHeader header = testing_motion::header();
  auto frames = testing_motion::gesture(header, 5);
  Random random(10);
  for (MotionFrame& frame : frames) {
    frame.hands = testing_motion::random_hands(header.body, frame.pose, random);
  }
  const auto written = [&] {
    return testing_bap::parse_bap(testing_motion::encode_all(*make_bap_encoder("iso"), header, frames));
  };
  EXPECT_EQ(written().frames[2].values.count(id_named("l_index1_flexion")), 0U);
  header.fingers = true;
  const auto file = written();
  EXPECT_EQ(file.frames[2].values.size(), kAngleCount + kFingerBapCount);
  EXPECT_EQ(file.frames[2].values.at(id_named("l_index2_flexion")),
            value_of(bap_profile("iso"), *frames[2].hands, "l_index2_flexion"));
}

}  // namespace
}  // namespace telemime
