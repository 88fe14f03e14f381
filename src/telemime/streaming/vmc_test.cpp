// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/all.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/outputs/humanoid.h"
#include "telemime/outputs/testing_motion.h"
#include "telemime/outputs/vrm_expressions.h"
#include "telemime/streaming/sender.h"
#include "telemime/streaming/testing_osc.h"
#include "telemime/streaming/testing_receivers.h"
#include "telemime/streaming/vmc_messages.h"

namespace telemime {
namespace {

using testing_osc::Marionette;
using testing_osc::OscMessage;
using testing_osc::UnityPlace;
using testing_receivers::comes_true;
using testing_receivers::ends_at_once;
using testing_receivers::kTaken;
using testing_receivers::UdpReceiver;

constexpr std::size_t kBones = 19;
constexpr double kHalfTurn = std::numbers::pi;

std::string url_of(std::uint16_t port, const std::string& options = "") {
  return "vmc://127.0.0.1:" + std::to_string(port) + options;
}

struct ReceivedFrame {
  Marionette marionette;
  std::vector<std::string> datagrams;
  std::size_t messages = 0;
};

/// Everything up to the message that ends a frame: the last bone, or the time when the person is lost.
ReceivedFrame next_frame(UdpReceiver& receiver, bool lost = false) {
  ReceivedFrame frame;
  while (lost ? frame.marionette.time < 0.0F : frame.marionette.bones.size() < kBones) {
    const auto datagram = receiver.receive();
    if (!datagram) {
      ADD_FAILURE() << "no more datagrams, " << frame.marionette.bones.size() << " bones";
      break;
    }
    frame.datagrams.push_back(*datagram);
    for (const OscMessage& message : testing_osc::parse_osc(*datagram)) {
      frame.marionette.take(message);
      ++frame.messages;
    }
  }
  return frame;
}

// The axes of a VRM 1.0 model again: Unity's frame is its mirror image in x.
Eigen::Vector3d position_of(const UnityPlace& place) {
  return {-place.position.at(0), place.position.at(1), place.position.at(2)};
}
Eigen::Quaterniond rotation_of(const UnityPlace& place) {
  return {place.rotation.at(3), place.rotation.at(0), -place.rotation.at(1), -place.rotation.at(2)};
}

std::string unity_name(std::size_t bone) {
  static const std::array<std::string, kBones> kNames = {
      "Hips",          "Spine",         "Chest",         "Neck",         "Head",
      "LeftShoulder",  "LeftUpperArm",  "LeftLowerArm",  "LeftHand",     "RightShoulder",
      "RightUpperArm", "RightLowerArm", "RightHand",     "LeftUpperLeg", "LeftLowerLeg",
      "LeftFoot",      "RightUpperLeg", "RightLowerLeg", "RightFoot"};
  return kNames.at(bone);
}

class Vmc : public ::testing::Test {
 protected:
  MotionFrame frame_of(const Pose& pose, std::int64_t index) const {
    return testing_motion::frame_of(header_.body, header_.camera, pose, index, header_.fps);
  }
  Pose random_pose() { return testing_motion::random_pose(header_.limits, random_); }

  void expect_equal(const Marionette& got, const HumanoidMotion& sent) const {
    for (std::size_t b = 0; b < kBones; ++b) {
      const auto found = got.bones.find(unity_name(b));
      ASSERT_NE(found, got.bones.end()) << unity_name(b);
      EXPECT_LT(rotation_of(found->second).angularDistance(sent.rotation[b]), 1e-4) << unity_name(b);
      const Eigen::Vector3d place = b == 0 ? sent.hips : skeleton_.offset(static_cast<HumanBone>(b));
      EXPECT_LT((position_of(found->second) - place).norm(), 1e-4) << unity_name(b);
    }
  }

  StreamHeader header_ = testing_motion::header();
  HumanoidSkeleton skeleton_ = humanoid_skeleton(header_.body);
  Random random_{3};
  UdpReceiver receiver_;
};

TEST_F(Vmc, RotationsAndPositionsAreThoseThatWereSent) {
  const auto sender = make_sender(url_of(receiver_.port()));
  sender->begin(header_);
  Eigen::Vector3d origin;
  for (int t = 0; t < 20; ++t) {
    const MotionFrame frame = frame_of(random_pose(), t);
    if (t == 0) {
      origin = frame.pose.root;
    }
    sender->send(frame, kTaken);
    const ReceivedFrame got = next_frame(receiver_);
    EXPECT_EQ(got.marionette.ok, (std::vector<std::int32_t>{1, 3, 0, 1}));
    EXPECT_FLOAT_EQ(got.marionette.time, static_cast<float>(frame.time));
    EXPECT_EQ(got.marionette.root.position, (std::vector<float>{0, 0, 0}));
    EXPECT_EQ(got.marionette.root.rotation, (std::vector<float>{0, 0, 0, 1}));
    EXPECT_EQ(got.marionette.bones.size(), kBones);
    expect_equal(got.marionette, humanoid_motion(header_.body, frame.pose, origin));
    ASSERT_EQ(got.datagrams.size(), 1U) << "nothing is divided within one computer";
    EXPECT_EQ(got.datagrams[0].substr(0, 8), std::string("#bundle\0", 8));
  }
  EXPECT_TRUE(comes_true([&] { return sender->status().sent == 20; }));
  EXPECT_EQ(sender->status().state, SenderState::sending);
  EXPECT_EQ(sender->status().dropped, 0);
}

TEST_F(Vmc, FingersHaveTheNamesAndRotationsOfUnity) {
  MotionFrame frame = frame_of(random_pose(), 0);
  frame.hands.emplace();
  for (HandMotion& hand : *frame.hands) {
    for (std::size_t a = 0; a < kHandAngleCount; ++a) {
      hand.angles[a] = random_.uniform(hand_limits()[a].min, hand_limits()[a].max);
    }
  }
  place_hands(forward_kinematics(header_.body, frame.pose), *frame.hands);
  const HumanoidMotion motion = humanoid_motion(header_.body, frame, frame.pose.root);
  Marionette got;
  for (const std::string& datagram : vmc_datagrams(skeleton_, &motion, nullptr, 0.0, {})) {
    for (const OscMessage& message : testing_osc::parse_osc(datagram)) {
      got.take(message);
    }
  }
  EXPECT_EQ(got.bones.size(), kBones + kFingerBoneCount);
  const std::array<std::pair<const char*, std::size_t>, 5> expected = {{{"LeftThumbProximal", 0},
                                                                        {"LeftThumbIntermediate", 1},
                                                                        {"LeftThumbDistal", 2},
                                                                        {"LeftIndexProximal", 3},
                                                                        {"RightLittleDistal", 29}}};
  for (const auto& [name, bone] : expected) {
    const auto found = got.bones.find(name);
    ASSERT_NE(found, got.bones.end()) << name;
    EXPECT_LT(rotation_of(found->second).angularDistance((*motion.fingers)[bone]), 1e-4) << name;
  }
  EXPECT_GT(position_of(got.bones.at("LeftIndexProximal")).x(), 0.05) << "along the arm of the T-pose";
}

TEST_F(Vmc, EachBundleIsCompleteInItself) {
  const Pose pose = random_pose();
  const HumanoidMotion motion = humanoid_motion(header_.body, pose, pose.root);
  for (const std::size_t largest :
       {std::size_t{200}, std::size_t{600}, kLargestDatagram, kLargestLocalDatagram}) {
    VmcOptions options;
    options.largest = largest;
    const auto datagrams = vmc_datagrams(skeleton_, &motion, nullptr, 2.5, options);
    EXPECT_EQ(datagrams.size() == 1, largest == kLargestLocalDatagram);
    Marionette all;
    for (const std::string& datagram : datagrams) {
      EXPECT_LE(datagram.size(), largest) << "fits an Ethernet frame with the heads of IP and UDP";
      Marionette one;
      for (const OscMessage& message : testing_osc::parse_osc(datagram)) {
        one.take(message);
        all.take(message);
      }
      EXPECT_EQ(one.ok, (std::vector<std::int32_t>{1, 3, 0, 1}));
      EXPECT_FLOAT_EQ(one.time, 2.5F);
    }
    expect_equal(all, motion);
  }
}

TEST_F(Vmc, AnArmThatPointsAtTheCameraPointsForward) {
  Pose pose;
  pose[Angle::l_shoulder_flexion] = -0.5 * kHalfTurn;
  const auto sender = make_sender(url_of(receiver_.port()));
  sender->begin(header_);
  sender->send(frame_of(pose, 0), kTaken);
  const auto bones = next_frame(receiver_).marionette.bones;
  // Kinematics as a receiver does them, in Unity's frame: x to the avatar's right, y up, z forward.
  Eigen::Affine3d wrist = Eigen::Affine3d::Identity();
  Eigen::Vector3d shoulder;
  for (const char* const name :
       {"Hips", "Spine", "Chest", "LeftShoulder", "LeftUpperArm", "LeftLowerArm", "LeftHand"}) {
    const auto& p = bones.at(name).position;
    const auto& q = bones.at(name).rotation;
    wrist = wrist * Eigen::Translation3d(p[0], p[1], p[2]) * Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
    if (std::string(name) == "LeftUpperArm") {
      shoulder = wrist.translation();
    }
  }
  EXPECT_LT(shoulder.x(), -0.1) << "the left shoulder is on Unity's -x side";
  EXPECT_GT((wrist.translation() - shoulder).normalized().z(), 0.999);
}

TEST_F(Vmc, SingleMessagesWithoutBundles) {
  const auto sender = make_sender(url_of(receiver_.port(), "?bundle=0"));
  sender->begin(header_);
  const MotionFrame frame = frame_of(random_pose(), 0);
  sender->send(frame, kTaken);
  const ReceivedFrame got = next_frame(receiver_);
  EXPECT_EQ(got.datagrams.size(), kBones + 3);
  EXPECT_EQ(got.messages, kBones + 3);
  for (const std::string& datagram : got.datagrams) {
    EXPECT_EQ(datagram.substr(0, 9), "/VMC/Ext/");
  }
  expect_equal(got.marionette, humanoid_motion(header_.body, frame.pose, frame.pose.root));
}

TEST_F(Vmc, ExpressionsInTheNamesThatAreAskedFor) {
  MotionFrame frame = frame_of(random_pose(), 0);
  frame.face = testing_motion::random_face(random_);
  const auto weights = vrm_expressions(*frame.face);
  constexpr std::pair<const char*, const char*> kCases[] = {
      {"", "Blink_L"}, {"?expressions=vrm1", "blinkLeft"}, {"?expressions=arkit", "eyeBlinkLeft"}};
  for (const auto& [query, blink] : kCases) {
    UdpReceiver receiver;
    const auto sender = make_sender(url_of(receiver.port(), query));
    sender->begin(header_);
    sender->send(frame, kTaken);
    const ReceivedFrame got = next_frame(receiver);
    const bool arkit = std::string(query).ends_with("arkit");
    EXPECT_EQ(got.marionette.blends.size(), arkit ? kExpressionCount : kVrmExpressionCount);
    EXPECT_TRUE(got.marionette.applied);
    EXPECT_FLOAT_EQ(got.marionette.blends.at(blink),
                    static_cast<float>(arkit ? (*frame.face)[Expression::eye_blink_left] : weights[11]));
  }
  EXPECT_THROW(make_sender(url_of(receiver_.port(), "?expressions=all")), Error);
}

TEST_F(Vmc, FaceComesToRestWhenItIsNotSeen) {
  enum class End { face_unseen, person_lost, farewell };
  for (const End end : {End::face_unseen, End::person_lost, End::farewell}) {
    UdpReceiver receiver;
    auto sender = make_sender(url_of(receiver.port(), "?expressions=arkit"));
    sender->begin(header_);
    MotionFrame frame = frame_of(random_pose(), 0);
    frame.face = testing_motion::random_face(random_);
    sender->send(frame, kTaken);
    next_frame(receiver);
    const bool lost = end == End::person_lost;
    frame.state = lost ? TrackState::lost : TrackState::tracking;
    frame.face->expressions[0] = 0.25;  // it comes to rest
    sender->send(frame, kTaken);
    EXPECT_FLOAT_EQ(next_frame(receiver, lost).marionette.blends.at("browDownLeft"), 0.25F);
    frame.face.reset();
    if (end == End::farewell) {
      sender.reset();
    } else {
      sender->send(frame, kTaken);
    }
    const Marionette got = next_frame(receiver, end != End::face_unseen).marionette;
    EXPECT_EQ(got.blends.size(), kExpressionCount);
    EXPECT_TRUE(got.applied);
    for (const auto& [name, weight] : got.blends) {
      EXPECT_EQ(weight, 0.0F) << name;
    }
  }
}

TEST_F(Vmc, PositionsOfTheHipsAlone) {
  header_.body = make_body([] {
    Shape tall;
    tall.stature = 1.95;
    return tall;
  }());
  skeleton_ = humanoid_skeleton(header_.body);
  const HumanoidSkeleton average = humanoid_skeleton(make_body(Shape()));
  const auto sender = make_sender(url_of(receiver_.port(), "?positions=hips"));
  sender->begin(header_);
  sender->send(frame_of(random_pose(), 0), kTaken);
  for (const auto& [name, place] : next_frame(receiver_).marionette.bones) {
    if (name == "Hips") {
      EXPECT_LT((position_of(place) - skeleton_.position[0]).norm(), 1e-4);
    } else {
      std::size_t bone = 1;
      while (unity_name(bone) != name) {
        ++bone;
      }
      EXPECT_LT((position_of(place) - average.offset(static_cast<HumanBone>(bone))).norm(), 1e-4) << name;
      EXPECT_GT(position_of(place).norm(), 0.01) << name;
    }
  }
}

TEST_F(Vmc, TheRootMovesOnRequest) {
  const auto sender = make_sender(url_of(receiver_.port(), "?root=moves"));
  sender->begin(header_);
  Pose pose;
  sender->send(frame_of(pose, 0), kTaken);
  next_frame(receiver_);
  pose.root += Eigen::Vector3d(0.2, -0.1, -0.3);  // to the camera's right, up, toward the camera
  sender->send(frame_of(pose, 1), kTaken);
  const Marionette got = next_frame(receiver_).marionette;
  // The camera's right is the left of a person who faces it: Unity's -x.
  const std::vector<float> moved = {-0.2F, 0.1F, 0.3F};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(got.root.position.at(i), moved[i], 1e-4);
  }
  EXPECT_LT((position_of(got.bones.at("Hips")) - skeleton_.position[0]).norm(), 1e-4);
}

TEST_F(Vmc, MirroredOnRequest) {
  const auto sender = make_sender(url_of(receiver_.port(), "?mirror=1"));
  sender->begin(header_);
  const MotionFrame frame = frame_of(random_pose(), 0);
  sender->send(frame, kTaken);
  const Pose mirrored_pose = mirrored(frame.pose);
  expect_equal(next_frame(receiver_).marionette,
               humanoid_motion(header_.body, mirrored_pose, mirrored_pose.root));
}

TEST_F(Vmc, ALostPersonIsToldAndLeavesTheBonesAlone) {
  const auto sender = make_sender(url_of(receiver_.port()));
  sender->begin(header_);
  MotionFrame frame = frame_of(random_pose(), 0);
  frame.state = TrackState::lost;
  sender->send(frame, kTaken);
  const ReceivedFrame got = next_frame(receiver_, true);
  EXPECT_EQ(got.messages, 2U);
  EXPECT_EQ(got.marionette.ok, (std::vector<std::int32_t>{1, 3, 0, 0}));
  frame.state = TrackState::tracking;
  frame.pose.angles[0] = std::nan("");
  sender->send(frame, kTaken);
  EXPECT_EQ(next_frame(receiver_, true).marionette.ok.at(3), 0) << "an impossible pose is a lost one";
}

TEST_F(Vmc, AtTheEndNobodyIsFollowedAnyMore) {
  auto sender = make_sender(url_of(receiver_.port()));
  sender->begin(header_);
  MotionFrame frame = frame_of(random_pose(), 0);
  sender->send(frame, kTaken);
  EXPECT_EQ(next_frame(receiver_).marionette.ok.at(3), 1);
  sender.reset();
  EXPECT_EQ(next_frame(receiver_, true).marionette.ok.at(3), 0);

  sender = make_sender(url_of(receiver_.port()));
  sender->begin(header_);
  frame.state = TrackState::lost;
  sender->send(frame, kTaken);
  EXPECT_EQ(next_frame(receiver_, true).marionette.ok.at(3), 0);
  sender.reset();
  EXPECT_FALSE(receiver_.receive(100)) << "that was said already";
}

TEST_F(Vmc, AnotherPersonHasOtherOffsets) {
  const auto sender = make_sender(url_of(receiver_.port()));
  sender->begin(header_);
  sender->send(frame_of(random_pose(), 0), kTaken);
  next_frame(receiver_);
  header_.body = make_body(Shape{1.5, {}, 0.5});
  skeleton_ = humanoid_skeleton(header_.body);
  sender->begin(header_);
  const MotionFrame frame = frame_of(random_pose(), 1);
  sender->send(frame, kTaken);
  expect_equal(next_frame(receiver_).marionette, humanoid_motion(header_.body, frame.pose, frame.pose.root));
}

TEST(VmcWithoutReceiver, IsReportedInWordsAndFoundLater) {
  const StreamHeader header = testing_motion::header();
  const auto frames = testing_motion::gesture(header, 1);
  const std::uint16_t port = testing_receivers::free_port(SOCK_DGRAM);
  const auto sender = make_sender(url_of(port));
  EXPECT_EQ(sender->status().url, url_of(port));
  sender->begin(header);
  EXPECT_TRUE(comes_true([&] {
    sender->send(frames[0], kTaken);
    return sender->status().state == SenderState::failed && sender->status().dropped > 10;
  }));
  EXPECT_EQ(sender->status().words, "no program is listening there; trying again");
  EXPECT_EQ(sender->status().receivers, 0);
  UdpReceiver receiver(port);
  EXPECT_TRUE(comes_true([&] {
    sender->send(frames[0], kTaken);
    return sender->status().state == SenderState::sending;
  }));
  EXPECT_EQ(sender->status().words, "");
  EXPECT_EQ(next_frame(receiver).marionette.bones.size(), kBones);
}

TEST(VmcWithoutReceiver, AnUnknownComputerIsReportedAndEndsAtOnce) {
  auto sender = make_sender("vmc://nowhere.invalid:39539");
  EXPECT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; }));
  EXPECT_NE(sender->status().words.find("nowhere.invalid"), std::string::npos);
  EXPECT_TRUE(ends_at_once(std::move(sender)));
}

}  // namespace
}  // namespace telemime
