// SPDX-License-Identifier: Apache-2.0
// VRChat's trackers, decoded as its documentation says: Unity's frame, Euler angles about z, then x, then y.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "telemime/body/arm_parts.h"
#include "telemime/core/errors.h"
#include "telemime/outputs/testing_motion.h"
#include "telemime/streaming/all.h"
#include "telemime/streaming/testing_osc.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime {
namespace {

using testing_receivers::comes_true;
using testing_receivers::kTaken;
using testing_receivers::UdpReceiver;

constexpr double kDegree = std::numbers::pi / 180.0;

/// What VRChat knows of a tracker, in Unity's frame.
struct Seen {
  Eigen::Vector3d position{NAN, NAN, NAN};
  Eigen::Vector3d degrees{NAN, NAN, NAN};

  /// Unity's Quaternion.Euler: about z first, then x, then y.
  Eigen::Quaterniond turn() const {
    return Eigen::AngleAxisd(kDegree * degrees.y(), Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(kDegree * degrees.x(), Eigen::Vector3d::UnitX()) *
           Eigen::AngleAxisd(kDegree * degrees.z(), Eigen::Vector3d::UnitZ());
  }
};
using Trackers = std::map<std::string, Seen>;

class Vrchat : public ::testing::Test {
 protected:
  std::string url(const std::string& options = "") const {
    return "vrchat://127.0.0.1:" + std::to_string(receiver_.port()) + options;
  }
  MotionFrame frame_of(const Pose& pose, std::int64_t index = 0) const {
    return testing_motion::frame_of(header_.body, header_.camera, pose, index, header_.fps);
  }
  /// The trackers of a datagram.
  static Trackers decoded(const std::string& datagram) {
    Trackers trackers;
    const std::string start = "/tracking/trackers/";
    for (const testing_osc::OscMessage& message : testing_osc::parse_osc(datagram)) {
      EXPECT_EQ(message.types, "fff") << message.path;
      EXPECT_EQ(message.path.substr(0, start.size()), start);
      const std::size_t slash = message.path.find('/', start.size());
      Seen& seen = trackers[message.path.substr(start.size(), slash - start.size())];
      const std::string kind = message.path.substr(slash + 1);
      EXPECT_TRUE(kind == "position" || kind == "rotation") << kind;
      (kind == "position" ? seen.position : seen.degrees) =
          Eigen::Vector3d(message.floats.at(0), message.floats.at(1), message.floats.at(2));
    }
    return trackers;
  }
  Trackers sent(const MotionFrame& frame, const std::string& options = "") {
    const auto sender = make_sender(url(options));
    sender->begin(header_);
    sender->send(frame, kTaken);
    const auto datagram = receiver_.receive();
    EXPECT_TRUE(datagram);
    return decoded(datagram.value_or(""));
  }

  StreamHeader header_ = testing_motion::header();
  Random random_{5};
  UdpReceiver receiver_;
};

TEST_F(Vrchat, UprightPersonHasNoRotations) {
  const Trackers seen = sent(frame_of(Pose()), "?trackers=hips,chest,elbows,hands");
  ASSERT_EQ(seen.size(), 7U);
  for (const char* const part : {"head", "1", "2"}) {
    EXPECT_LT(seen.at(part).degrees.norm(), 1e-3) << part << ": 0, 0, 0 is a neutral forward direction";
    EXPECT_NEAR(seen.at(part).position.x(), 0.0, 1e-4) << part;
  }
  const double height = seen.at("head").position.y();
  EXPECT_GT(height, 0.8 * header_.body.shape.stature) << "metres above the floor";
  EXPECT_LT(height, header_.body.shape.stature);
  EXPECT_GT(height, seen.at("2").position.y());
  EXPECT_GT(seen.at("2").position.y(), seen.at("1").position.y());
  for (const auto& [left, right] : {std::pair("3", "4"), std::pair("5", "6")}) {
    EXPECT_LT(seen.at(left).position.x(), -0.1) << "Unity's x is to the right of who faces +z";
    EXPECT_NEAR(seen.at(left).position.x(), -seen.at(right).position.x(), 1e-3);
    EXPECT_LT(seen.at(left).position.y(), seen.at("2").position.y()) << "hanging arms";
  }
}

TEST_F(Vrchat, PositionsAreTheTrackedJoints) {
  const std::map<std::string, std::size_t> joints = {{"3", 0}, {"4", 1}, {"5", 2}, {"6", 3}};
  for (int t = 0; t < 10; ++t) {
    const Pose pose = testing_motion::random_pose(header_.limits, random_);
    const Trackers seen = sent(frame_of(pose));
    EXPECT_EQ(seen.size(), 6U) << "head, chest, elbows, hands";
    const Kinematics k = forward_kinematics(header_.body, pose);
    const std::array<Eigen::Vector3d, 4> camera = {
        k[Segment::l_forearm].translation(), k[Segment::r_forearm].translation(),
        k[Segment::l_hand].translation(), k[Segment::r_hand].translation()};
    for (const auto& [a, i] : joints) {
      for (const auto& [b, j] : joints) {
        // Camera: x to the person's left, y down, z away. Unity: x to the person's right, y up, z toward it.
        const Eigen::Vector3d apart = seen.at(a).position - seen.at(b).position;
        EXPECT_LT((apart + (camera[i] - camera[j])).norm(), 0.02) << a << ' ' << b;
      }
    }
  }
}

TEST_F(Vrchat, RotationsComposeToThePose) {
  for (int t = 0; t < 20; ++t) {
    const Pose pose = testing_motion::random_pose(header_.limits, random_);
    const Trackers seen = sent(frame_of(pose));
    // An upper arm along Unity's -x (left) at rest points from the shoulder to the elbow; so do forearm and
    // hand.
    const Kinematics k = forward_kinematics(header_.body, pose);
    for (const Side side : {Side::left, Side::right}) {
      const bool left = side == Side::left;
      const Eigen::Vector3d shoulder = k[arm_parts(side).upper_arm].translation();
      const Eigen::Vector3d elbow = k[arm_parts(side).forearm].translation();
      const Eigen::Vector3d rest = (left ? -1.0 : 1.0) * Eigen::Vector3d::UnitX();
      const Eigen::Vector3d points = seen.at(left ? "3" : "4").turn() * rest;
      EXPECT_LT((points + (elbow - shoulder).normalized()).norm(), 0.06);
    }
  }
}

TEST_F(Vrchat, HeadTurnedToTheLeftHasANegativeYaw) {
  MotionFrame frame = frame_of(Pose());
  frame.face.emplace();
  frame.face->confidence = 1.0;
  // The camera's y points down: a positive turn about it brings the face, which looks along -z, to -x ...
  frame.face->head = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY());
  const Trackers right = sent(frame);
  // ... the camera's left, which is the right of who faces it: Unity's +x, a positive yaw.
  EXPECT_NEAR(right.at("head").degrees.y(), 0.5 / kDegree, 0.1);
  EXPECT_NEAR((right.at("head").turn() * Eigen::Vector3d::UnitZ()).x(), std::sin(0.5), 1e-3);
  frame.face->head = Eigen::AngleAxisd(-0.5, Eigen::Vector3d::UnitY());
  EXPECT_NEAR(sent(frame).at("head").degrees.y(), -0.5 / kDegree, 0.1);
  frame.face->head = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d nod = sent(frame).at("head").turn() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(std::abs(nod.y()), std::sin(0.3), 1e-3);
  EXPECT_LT(nod.y(), 0.0) << "about the camera's x, the face goes down";
}

TEST_F(Vrchat, RaisedArmIsAboveTheHead) {
  Pose pose;
  pose[Angle::l_shoulder_abduct] = std::numbers::pi;
  const Trackers seen = sent(frame_of(pose));
  EXPECT_GT(seen.at("5").position.y(), seen.at("head").position.y() + 0.2);
  EXPECT_GT(seen.at("5").position.y(), seen.at("3").position.y() + 0.15);
  EXPECT_LT(seen.at("6").position.y(), seen.at("2").position.y());
  EXPECT_GT((seen.at("3").turn() * -Eigen::Vector3d::UnitX()).y(), 0.98) << "the upper arm points up";
}

TEST_F(Vrchat, BigPersonHasBigDistances) {
  const auto span = [](const Trackers& seen) {
    return (seen.at("head").position - seen.at("2").position).norm();
  };
  const double usual = span(sent(frame_of(Pose())));
  Shape tall;
  tall.stature *= 1.2;
  header_.body = make_body(tall);
  EXPECT_NEAR(span(sent(frame_of(Pose()))) / usual, 1.2, 1e-3) << "1 is a metre";
}

TEST_F(Vrchat, ALostPersonSendsNothing) {
  auto sender = make_sender(url());
  sender->begin(header_);
  MotionFrame frame = frame_of(Pose());
  frame.state = TrackState::lost;
  sender->send(frame, kTaken);
  frame.state = TrackState::tracking;
  frame.pose.angles[0] = std::nan("");
  sender->send(frame, kTaken);
  EXPECT_TRUE(comes_true([&] { return sender->status().sent == 2; }));
  EXPECT_FALSE(receiver_.receive(200)) << "neither lost nor impossible poses";
  sender->send(frame_of(Pose(), 2), kTaken);
  EXPECT_TRUE(receiver_.receive());
  sender.reset();
  EXPECT_FALSE(receiver_.receive(100)) << "nor a farewell";
}

TEST_F(Vrchat, OptionsChooseWhatIsSent) {
  const MotionFrame frame = frame_of(Pose());
  EXPECT_EQ(sent(frame, "?trackers=hands").size(), 3U);
  EXPECT_EQ(sent(frame, "?trackers=hips").count("1"), 1U);
  const Trackers mirrored = sent(frame_of([] {
                                   Pose pose;
                                   pose[Angle::l_shoulder_abduct] = 1.0;
                                   return pose;
                                 }()),
                                 "?mirror=1");
  EXPECT_GT(mirrored.at("6").position.y(), mirrored.at("5").position.y() + 0.1);

  const auto sender = make_sender(url("?bundle=0"));
  sender->begin(header_);
  sender->send(frame, kTaken);
  for (int i = 0; i < 12; ++i) {
    const auto datagram = receiver_.receive();
    ASSERT_TRUE(datagram) << i;
    EXPECT_EQ(datagram->substr(0, 19), "/tracking/trackers/");
  }
}

TEST_F(Vrchat, BadUrlsHaveARemedy) {
  for (const char* const text :
       {"vrchat://", "vrchat://localhost/path", "vrchat://localhost?trackers=feet",
        "vrchat://localhost?trackers=", "vrchat://localhost?trackers=chest,", "vrchat://localhost?bundle=2",
        "vrchat://localhost?tracker=chest", "vrchat://localhost:0"}) {
    try {
      make_sender(text);
      ADD_FAILURE() << text;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::usage) << text;
      EXPECT_GT(std::string(e.what()).size(), 60U) << "what is wrong, and what to do: " << e.what();
    }
  }
  EXPECT_EQ(meaning_of("vrchat://localhost"), meaning_of("vrchat://127.0.0.1:9000"));
}

}  // namespace
}  // namespace telemime
