// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/all.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "telemime/core/testing_errors.h"
#include "telemime/outputs/readers/jsonl.h"
#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

using nlohmann::json;

std::string encoded(const StreamHeader& header, const std::vector<MotionFrame>& frames) {
  return testing_motion::encode_all(*make_jsonl_encoder(), header, frames);
}

std::vector<json> lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<json> result;
  for (std::string line; std::getline(stream, line);) {
    result.push_back(json::parse(line));
  }
  return result;
}

TEST(Jsonl, ReadsBackWhatItWrote) {
  StreamHeader header = testing_motion::header();
  Shape shape;
  shape.sleeve = 0.7;
  shape.shoulders = 0.9;
  header.body = make_body(shape);
  auto frames = testing_motion::gesture(header, 20);
  testing_motion::lose(frames, 7);
  const PoseFile file = parse_pose_jsonl(encoded(header, frames), "test");
  EXPECT_TRUE(file.complaint.empty());
  EXPECT_DOUBLE_EQ(file.fps, header.fps);
  EXPECT_DOUBLE_EQ(file.camera.fx, header.camera.fx);
  EXPECT_DOUBLE_EQ(file.camera.cy, header.camera.cy);
  EXPECT_DOUBLE_EQ(file.shape.stature, header.body.shape.stature);
  EXPECT_DOUBLE_EQ(file.shape.sleeve, shape.sleeve);
  EXPECT_DOUBLE_EQ(file.shape.shoulders, shape.shoulders);
  EXPECT_EQ(file.limits.name, header.limits.name);
  EXPECT_EQ(file.header.at("config"), header.config);
  EXPECT_EQ(file.header.at("extra"), header.extra);
  ASSERT_EQ(file.frames.size(), frames.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const MotionFrame& read = file.frames[f];
    EXPECT_EQ(read.frame, frames[f].frame);
    EXPECT_NEAR(read.time, frames[f].time, 1e-6);
    EXPECT_EQ(read.state, frames[f].state);
    EXPECT_LT((read.pose.vector() - frames[f].pose.vector()).cwiseAbs().maxCoeff(), 1e-5);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      EXPECT_LT((read.joints.at[j] - frames[f].joints.at[j]).norm(), 1e-5);
      EXPECT_LT((read.pixels[j] - frames[f].pixels[j]).norm(), 1e-3);
    }
    EXPECT_NEAR(read.region_score, frames[f].region_score, 1e-6);
    EXPECT_NEAR(read.contour_score, frames[f].contour_score, 1e-6);
    EXPECT_EQ(read.evaluations, frames[f].evaluations);
    EXPECT_EQ(read.stage_ms, frames[f].stage_ms);
  }
}

TEST(Jsonl, WritesMillimetresAndDegrees) {
  const StreamHeader header = testing_motion::header();
  Pose pose;
  pose.root = {0.1, 0.2, 1.5};
  pose[Angle::l_elbow_flexion] = -std::numbers::pi / 2.0;
  const auto text = encoded(header, {testing_motion::frame_of(header.body, header.camera, pose, 0, 25.0)});
  const json frame = lines(text).at(1);
  EXPECT_EQ(frame.at("root"), json({100.0, 200.0, 1500.0}));
  EXPECT_EQ(frame.at("joints").at("root"), frame.at("root"));
  EXPECT_DOUBLE_EQ(frame.at("angles").at("l_elbow_flexion"), -90.0);
}

TEST(Jsonl, EveryFrameHasEveryKeyEvenWhenLost) {
  const StreamHeader header = testing_motion::header();
  auto frames = testing_motion::gesture(header, 2);
  frames[1].state = TrackState::lost;
  frames[1].stage_ms.clear();
  const auto all = lines(encoded(header, frames));
  for (const auto& [key, value] : all.at(1).items()) {
    EXPECT_TRUE(all.at(2).contains(key)) << key;
    if (key != "ms") {
      EXPECT_EQ(all.at(2).at(key).size(), value.size()) << key;
    }
  }
  EXPECT_EQ(all.at(2).at("state"), "lost");
}

TEST(Jsonl, NeverWritesNumbersThatAreNotFinite) {
  const StreamHeader header = testing_motion::header();
  auto frames = testing_motion::gesture(header, 3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  frames[1].pose.angles[4] = nan;
  frames[2].pixels[3].x() = std::numeric_limits<double>::infinity();
  frames[2].region_score = nan;
  frames[2].stage_ms[0].second = -std::numeric_limits<double>::infinity();
  const std::string text = encoded(header, frames);
  EXPECT_EQ(text.find("null"), std::string::npos);
  const PoseFile file = parse_pose_jsonl(text, "test");
  EXPECT_EQ(file.frames[1].state, TrackState::lost);
  EXPECT_LT((file.frames[1].pose.vector() - frames[0].pose.vector()).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_EQ(file.frames[2].state, TrackState::tracking);
  EXPECT_NEAR(file.frames[2].region_score, 0.25, 1e-9);
}

TEST(Jsonl, FirstFrameWithoutFiniteNumbersIsTheRestPose) {
  const StreamHeader header = testing_motion::header();
  auto frames = testing_motion::gesture(header, 1);
  frames[0].joints.at.fill(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  const PoseFile file = parse_pose_jsonl(encoded(header, frames), "test");
  EXPECT_EQ(file.frames.at(0).state, TrackState::lost);
  EXPECT_EQ(file.frames.at(0).pose.angles, Pose{}.angles);
}

TEST(Jsonl, BytesThatAreNotTextDoNotStopARun) {
  StreamHeader header = testing_motion::header();
  header.extra = {{"input", "clip\xff.mp4"}};
  EXPECT_EQ(parse_pose_jsonl(make_jsonl_encoder()->begin(header), "test").frames.size(), 0U);
}

TEST(Jsonl, ReadsBackTheHandsThatItWrote) {
  const StreamHeader header = testing_motion::header();
  auto frames = testing_motion::gesture(header, 2);
  frames[1].hands.emplace();
  HandMotion& hand = (*frames[1].hands)[1];
  hand.visibility = 0.75;
  hand.spread = 0.0123;
  hand.angles[5] = 0.2;
  hand.seen =
      Eigen::Quaterniond(forward_kinematics(header.body, frames[1].pose)[Segment::r_forearm].linear() *
                         wrist_rotation({0.3, -0.1, 0.5}));
  place_hands(forward_kinematics(header.body, frames[1].pose), *frames[1].hands);
  const PoseFile file = parse_pose_jsonl(encoded(header, frames), "test");
  EXPECT_FALSE(file.frames.at(0).hands);
  ASSERT_TRUE(file.frames.at(1).hands);
  for (std::size_t side = 0; side < 2; ++side) {
    const HandMotion& read = (*file.frames[1].hands)[side];
    const HandMotion& wrote = (*frames[1].hands)[side];
    EXPECT_NEAR(read.visibility, wrote.visibility, 1e-3);
    EXPECT_NEAR(read.spread, wrote.spread, 1e-5);
    EXPECT_NEAR(read.wrist.twisting, wrote.wrist.twisting, 1e-5);
    EXPECT_NEAR(read.wrist.flexion, wrote.wrist.flexion, 1e-5);
    for (std::size_t a = 0; a < kHandAngleCount; ++a) {
      EXPECT_NEAR(read.angles[a], wrote.angles[a], 1e-4);
    }
    for (std::size_t j = 0; j < kHandJointCount; ++j) {
      EXPECT_LT((read.joints[j] - wrote.joints[j]).norm(), 1e-5);
    }
  }
}

TEST(Jsonl, HandsThatAreNotFiniteAreThoseOfTheFrameBefore) {
  const StreamHeader header = testing_motion::header();
  auto frames = testing_motion::gesture(header, 2);
  for (MotionFrame& frame : frames) {
    frame.hands.emplace();
  }
  (*frames[0].hands)[0].angles[3] = 0.5;
  (*frames[1].hands)[0].joints[7].x() = std::numeric_limits<double>::quiet_NaN();
  const PoseFile file = parse_pose_jsonl(encoded(header, frames), "test");
  EXPECT_NEAR((*file.frames.at(1).hands)[0].angles[3], 0.5, 1e-4);
  EXPECT_EQ(file.frames.at(1).state, TrackState::tracking);
}

// Something else for each joint, symmetric.
PoseSpread some_spread() {
  PoseSpread spread;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const double m = 1e-4 * static_cast<double>(1 + j);  // m^2
    spread.covariance[j] << 4 * m, m, -m, m, 5 * m, 0.5 * m, -m, 0.5 * m, 9 * m;
  }
  spread.second_mode = 0.125;
  spread.effective_particles = 37.5;
  return spread;
}

TEST(Jsonl, ReadsBackTheSpreadThatItWrote) {
  const StreamHeader header = testing_motion::header();
  auto frames = testing_motion::gesture(header, 3);
  frames[1].spread = some_spread();
  const std::string text = encoded(header, frames);
  const PoseFile file = parse_pose_jsonl(text, "test");
  ASSERT_EQ(file.frames.size(), 3U);
  EXPECT_FALSE(file.frames[0].spread) << "none was stated";
  EXPECT_FALSE(file.frames[2].spread);
  ASSERT_TRUE(file.frames[1].spread);
  const PoseSpread& read = *file.frames[1].spread;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    // Written in tenths of a square millimetre.
    EXPECT_LT((read.covariance[j] - some_spread().covariance[j]).cwiseAbs().maxCoeff(), 0.051e-6);
    EXPECT_EQ(read.covariance[j], read.covariance[j].transpose());
  }
  EXPECT_DOUBLE_EQ(read.second_mode, 0.125);
  EXPECT_DOUBLE_EQ(read.effective_particles, 37.5);
  const json head = lines(text).at(2).at("spread").at("covariance").at("head");
  EXPECT_EQ(head, json({1200.0, 300.0, -300.0, 1500.0, 150.0, 2700.0})) << "mm^2: xx, xy, xz, yy, yz, zz";
}

TEST(Jsonl, ASpreadThatIsNotFiniteIsLeftOut) {
  const StreamHeader header = testing_motion::header();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int broken = 0; broken < 3; ++broken) {
    auto frames = testing_motion::gesture(header, 2);
    frames[0].spread = frames[1].spread = some_spread();
    PoseSpread& spread = *frames[1].spread;
    (broken == 0   ? spread.covariance[4](1, 1)
     : broken == 1 ? spread.second_mode
                   : spread.effective_particles) = nan;
    const PoseFile file = parse_pose_jsonl(encoded(header, frames), "test");
    EXPECT_TRUE(file.frames.at(0).spread);
    EXPECT_FALSE(file.frames.at(1).spread) << broken;
    EXPECT_EQ(file.frames.at(1).state, TrackState::tracking);
  }
}

TEST(Jsonl, ReadsBackTheFaceThatItWrote) {
  const StreamHeader header = testing_motion::header();
  Random random(4);
  MotionFrame frame = testing_motion::frame_of(header.body, header.camera, Pose{}, 0, header.fps);
  frame.face = testing_motion::random_face(random);
  const auto encoder = make_jsonl_encoder();
  const std::string text = encoder->begin(header) + encoder->frame(frame);
  const PoseFile file = parse_pose_jsonl(text, "face");
  ASSERT_TRUE(file.frames.at(0).face);
  const FaceMotion& read = *file.frames[0].face;
  EXPECT_NEAR(read.confidence, frame.face->confidence, 1e-3);
  EXPECT_LT(read.head.angularDistance(frame.face->head), 1e-5);
  EXPECT_LT((read.gaze - frame.face->gaze).norm(), 1e-4);
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    EXPECT_NEAR(read.expressions[i], frame.face->expressions[i], 1e-3);
  }
  EXPECT_NE(text.find("\"tongueOut\""), std::string::npos);
  // One that is not finite is left out; one that cannot be is refused.
  frame.face->gaze.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(encoder->frame(frame).find("face"), std::string::npos);
  const auto refused = [&](const std::string& place, const json& value, const std::string& words) {
    json wrong = json::parse(text.substr(text.find('\n') + 1));
    wrong[json::json_pointer("/face" + place)] = value;
    const std::string said = error_of(ErrorKind::input, [&] {
      parse_pose_jsonl(text.substr(0, text.find('\n') + 1) + wrong.dump() + "\n\n", "face");
    });
    EXPECT_NE(said.find(words), std::string::npos) << said;
  };
  refused("/confidence", 7, "between 0 and 1");
  refused("/confidence", -0.1, "between 0 and 1");
  refused("/head", json::array({0, 0, 0, 0}), "head");
  refused("/head", json::array({0, 0, 1}), "head");
}

TEST(JsonlReader, RefusesASpreadThatIsNone) {
  const StreamHeader header = testing_motion::header();
  auto frames = testing_motion::gesture(header, 1);
  frames[0].spread = some_spread();
  const auto all = lines(encoded(header, frames));
  const auto refused = [&](const std::string& place, const json& value, const std::string& word) {
    json frame = all.at(1);
    frame[json::json_pointer("/spread" + place)] = value;
    const std::string said = error_of(ErrorKind::input, [&] {
      parse_pose_jsonl(all.at(0).dump() + "\n" + frame.dump() + "\n" + "\n", "broken.jsonl");
    });
    EXPECT_NE(said.find("line 2"), std::string::npos) << said;
    EXPECT_NE(said.find(word), std::string::npos) << said;
  };
  refused("", 3, "spread");
  refused("", nullptr, "spread");
  refused("", json::object(), "covariance");
  refused("/covariance", json::object(), "root");
  refused("/covariance/l_wrist", json::array({1, 2, 3, 4, 5}), "covariance");
  refused("/covariance/l_wrist", json::array({1, 2, 3, 4, 5, 6, 7}), "covariance");
  refused("/covariance/l_wrist", json::array({1, 2, 3, "4", 5, 6}), "spread");
  refused("/covariance/l_wrist", 7.0, "covariance");
  refused("/second_mode", "much", "second_mode");
  refused("/effective_particles", nullptr, "effective_particles");
}

TEST(JsonlReader, ReportsALastLineThatWasCutOff) {
  const StreamHeader header = testing_motion::header();
  const std::string text = encoded(header, testing_motion::gesture(header, 3));
  const PoseFile file = parse_pose_jsonl(std::string_view(text).substr(0, text.size() - 40), "cut.jsonl");
  EXPECT_EQ(file.frames.size(), 2U);
  EXPECT_NE(file.complaint.find("cut.jsonl, line 4"), std::string::npos) << file.complaint;
}

TEST(JsonlReader, NamesTheLineAndWhatIsWrong) {
  const StreamHeader header = testing_motion::header();
  const std::string text = encoded(header, testing_motion::gesture(header, 2));
  const auto message_of = [](const std::string& broken) {
    return error_of(ErrorKind::input, [&] { parse_pose_jsonl(broken, "broken.jsonl"); });
  };
  const auto with = [&text](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return changed;
  };
  EXPECT_NE(message_of("").find("empty"), std::string::npos);
  EXPECT_NE(message_of("{\"format\":").find("not JSON"), std::string::npos);
  EXPECT_NE(message_of(with("telemime-pose", "other")).find("format"), std::string::npos);
  EXPECT_NE(message_of(with("\"version\":1", "\"version\":2")).find("version"), std::string::npos);
  EXPECT_NE(message_of(with("\"l_hand\":", "\"hand\":")).find("l_hand"), std::string::npos);
  EXPECT_NE(message_of(with("\"frame\":1", "\"frame\":0")).find("line 3"), std::string::npos);
  EXPECT_NE(message_of(with("\"state\":\"tracking\"", "\"state\":\"maybe\"")).find("state"),
            std::string::npos);
  EXPECT_NE(message_of(with("\"time\":0.0", "\"time\":1e999")).find("line 2"), std::string::npos);
  EXPECT_NE(message_of(std::string(1000, '[')).find("nested"), std::string::npos);
}

}  // namespace
}  // namespace telemime
