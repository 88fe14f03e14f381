// SPDX-License-Identifier: Apache-2.0
// A sender in a meeting: what it publishes, and how often.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "broker.h"
#include "checks.h"
#include "feeder.h"
#include "meeting/protocol/messages.h"
#include "meeting/protocol/pose_detail.h"
#include "meeting/protocol/publishing.h"
#include "meeting/transport/senders.h"
#include "telemime/outputs/numbers.h"
#include "telemime/streaming/person_motion.h"

namespace telemime::meeting::test_support {
namespace {

constexpr double kMicro = 1e-6;  // s

double seconds_between(const PoseFrame& first, const PoseFrame& last) {
  return static_cast<double>(last.captured - first.captured) * kMicro;
}

class ParticipantTest : public ::testing::Test {
 protected:
  bool frames_arrive(std::size_t count) const { return has_frames(subscriber_, "tracker", count); }

  Broker broker_;
  Subscriber subscriber_{broker_.port()};
};

TEST_F(ParticipantTest, FramesAreWhatWasSent) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  const StreamHeader header = testing_motion::header();
  const std::vector<MotionFrame> sent = testing_motion::gesture(header, 8, /*period=*/0.4);
  sender->begin(header);
  PersonMotion motion(header.body);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    MotionFrame frame = sent[i];
    if (i >= 4) {
      frame.spread.emplace();
      frame.spread->covariance.fill(Eigen::Matrix3d::Identity() * (0.11 * 0.11));
    }
    const double taken = 5000.25 + 40.0 * static_cast<double>(i);  // ms
    sender->send(frame, taken);
    ASSERT_TRUE(frames_arrive(i + 1));
    const PoseFrame received = subscriber_.frames("tracker").back();
    const auto meant = motion(motion.clean(frame));
    ASSERT_TRUE(meant);
    EXPECT_TRUE(received.tracked);
    EXPECT_FALSE(received.still);
    EXPECT_EQ(received.sequence, i);
    EXPECT_EQ(received.captured, static_cast<std::uint64_t>(std::llround(1000.0 * taken)));
    EXPECT_EQ(received.mask, kTrackedBones);
    for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
      if (received.has(bone)) {
        EXPECT_LT(received.rotation[bone].angularDistance(meant->rotation[bone]) * kDegreesPerRadian, 0.01);
        EXPECT_EQ(received.confidence[bone], i < 4 ? 0 : 8);
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(received.hips[axis], 1000.0 * meant->hips[static_cast<Eigen::Index>(axis)], 0.501);
    }
  }
  const std::vector<PoseFrame> all = subscriber_.frames("tracker");
  for (const PoseFrame& frame : all) {
    EXPECT_EQ(frame.session, all[0].session);
  }
  EXPECT_GE(sender->status().sent, static_cast<std::int64_t>(sent.size()) - 1);
}

TEST_F(ParticipantTest, HandsAndFaceFollowTheirFrame) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  const StreamHeader header = testing_motion::header();
  std::vector<MotionFrame> sent = testing_motion::gesture(header, 3, /*period=*/0.4);
  Random random(1);
  sender->begin(header);
  PersonMotion motion(header.body);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    MotionFrame& frame = sent[i];
    frame.face = testing_motion::random_face(random);
    frame.hands.emplace();
    (*frame.hands)[0].angles[6] = 0.2 + 0.3 * static_cast<double>(i);
    sender->send(frame, 5000.0 + 40.0 * static_cast<double>(i));
    ASSERT_TRUE(comes_true([&] { return subscriber_.payloads("p/tracker/pose").size() == 2 * (i + 1); }));
    const std::string bytes = subscriber_.payloads("p/tracker/pose").back();
    const auto detail =
        decode_pose_detail({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    ASSERT_TRUE(detail);
    const PoseFrame body = subscriber_.frames("tracker").back();
    EXPECT_EQ(detail->session, body.session);
    EXPECT_EQ(detail->sequence, body.sequence);
    const auto meant = motion(motion.clean(frame));
    ASSERT_TRUE(meant);
    EXPECT_EQ(detail->fingers, quantised(*meant->fingers));
    EXPECT_EQ(detail->face, quantised(*frame.face));
    const auto head = static_cast<std::size_t>(HumanBone::head);
    EXPECT_LT(body.rotation[head].angularDistance(meant->rotation[head]), 2e-4) << "as the face holds it";
  }
}

TEST_F(ParticipantTest, StateAndPresenceArePublished) {
  const auto sender =
      make_sender(broker_.url() + "?name=J%C3%B6rg&look=robot&seat=2&participant=p07", kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  ASSERT_TRUE(comes_true([&] { return subscriber_.json("p/p07/state").is_object(); }));
  EXPECT_FALSE(subscriber_.json("p/p07/state").contains("bones")) << "no person yet";
  const StreamHeader header = testing_motion::header();
  sender->begin(header);
  ASSERT_TRUE(comes_true([&] { return subscriber_.json("p/p07/state").contains("bones"); }));
  const auto state = read_state(subscriber_.newest("p/p07/state")->payload);
  const auto presence = read_presence(subscriber_.newest("p/p07/presence")->payload);
  ASSERT_TRUE(state && presence);
  EXPECT_EQ(state->name, "J\xc3\xb6rg");
  EXPECT_EQ(std::get<AvatarByLook>(state->avatar).look, "robot");
  EXPECT_EQ(state->seat, 2);
  EXPECT_EQ(state->kind, ParticipantKind::tracker);
  EXPECT_NEAR(*state->stature, header.body.shape.stature, 1e-5);
  EXPECT_LT((*state->bones[4] - humanoid_skeleton(header.body).position[4]).norm(), 2e-5);
  EXPECT_TRUE(presence->here);
  EXPECT_EQ(presence->session, state->session);
  EXPECT_EQ(presence->every, 1.25);

  Subscriber late(broker_.port());  // late subscribers get the same
  ASSERT_TRUE(comes_true([&] { return late.newest("p/p07/state") && late.newest("p/p07/presence"); }));
  EXPECT_EQ(late.newest("p/p07/state")->payload, subscriber_.newest("p/p07/state")->payload);
  EXPECT_TRUE(late.newest("p/p07/state")->retained);
  const std::vector<Subscriber::Received> received = late.all();
  EXPECT_TRUE(std::any_of(received.begin(), received.end(),
                          [](const auto& one) { return one.topic == "p/p07/presence" && one.retained; }));
}

TEST_F(ParticipantTest, PresenceIsRepeatedWithoutFrames) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  subscriber_.clear();
  const auto presences = [&] {
    std::vector<double> times;  // s
    for (const Subscriber::Received& one : subscriber_.all()) {
      if (one.topic == "p/tracker/presence" && !one.retained && read_presence(one.payload)->here) {
        times.push_back(one.at);
      }
    }
    return times;
  };
  ASSERT_TRUE(comes_true([&] { return presences().size() >= 4; }));
  const std::vector<double> times = presences();
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double gap = times[i] - times[i - 1];
    EXPECT_GT(gap, 0.5) << "no more often than needed";
    EXPECT_LT(gap, 3 * 1.25) << "nobody considers it gone";
  }
}

TEST_F(ParticipantTest, MirroredPersonIsMirrored) {
  const auto plain = make_sender(broker_.url(), kAllSenderKinds);
  const auto mirrored = make_sender(broker_.url() + "?participant=mirror&mirror=1", kAllSenderKinds);
  ASSERT_TRUE(is_sending(*plain) && is_sending(*mirrored));
  const StreamHeader header = testing_motion::header();
  const MotionFrame frame = testing_motion::gesture(header, 5)[4];
  for (const auto* const sender : {&plain, &mirrored}) {
    (*sender)->begin(header);
    (*sender)->send(frame, 1.0);
  }
  ASSERT_TRUE(frames_arrive(1) && comes_true([&] { return !subscriber_.frames("mirror").empty(); }));
  const PoseFrame a = subscriber_.frames("tracker")[0];
  const PoseFrame b = subscriber_.frames("mirror")[0];
  EXPECT_NE(a.session, b.session);
  const auto left = static_cast<std::size_t>(HumanBone::l_lower_arm);
  const auto right = static_cast<std::size_t>(HumanBone::r_lower_arm);
  const Eigen::Quaterniond& q = a.rotation[left];
  const Eigen::Quaterniond other(q.w(), q.x(), -q.y(), -q.z());
  EXPECT_LT(other.angularDistance(b.rotation[right]) * kDegreesPerRadian, 0.5);
}

TEST_F(ParticipantTest, RateFallsWhenOthersJoin) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  Feeder feeder(*sender);
  // Alone: 30 per second. Only a busy computer makes it less, but at least 12.
  ASSERT_TRUE(comes_true([&] {
    subscriber_.clear();
    const bool came = frames_arrive(31);
    const std::vector<PoseFrame> frames = subscriber_.frames("tracker");
    return came && seconds_between(frames[0], frames[30]) < 30.0 / 12.0;
  }));
  const std::vector<PoseFrame> alone = subscriber_.frames("tracker");
  EXPECT_GT(seconds_between(alone.front(), alone.back()), static_cast<double>(alone.size() - 1) / 30.0 - 0.1);

  for (int i = 1; i < 60; ++i) {
    subscriber_.publish("p/guest" + std::to_string(i) + "/presence", write_presence({true, 1}));
  }
  ASSERT_TRUE(comes_true([&] { return sender->status().receivers == 59; })) << sender->status().receivers;
  subscriber_.clear();
  ASSERT_TRUE(frames_arrive(11));
  const std::vector<PoseFrame> crowded = subscriber_.frames("tracker");
  EXPECT_GT(seconds_between(crowded[0], crowded[10]), 10 / 5.0 - 0.35) << "5 per second for 60 participants";

  for (int i = 1; i < 60; ++i) {
    subscriber_.publish("p/guest" + std::to_string(i) + "/presence", write_presence({false, 1}));
  }
  ASSERT_TRUE(comes_true([&] { return sender->status().receivers == 0; })) << sender->status().receivers;
  ASSERT_TRUE(comes_true([&] {
    subscriber_.clear();
    const bool came = frames_arrive(31);
    const std::vector<PoseFrame> frames = subscriber_.frames("tracker");
    return came && seconds_between(frames[0], frames[30]) < 30.0 / 12.0;
  })) << "the rate does not rise again";
}

TEST_F(ParticipantTest, StillPersonIsPublishedTwicePerSecond) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  Feeder feeder(*sender);
  ASSERT_TRUE(frames_arrive(3));
  feeder.stand_still(true);
  ASSERT_TRUE(comes_true([&] {
    const auto frames = subscriber_.frames("tracker");
    return !frames.empty() && frames.back().still;
  }));
  subscriber_.clear();
  ASSERT_TRUE(frames_arrive(5));
  const std::vector<PoseFrame> still = subscriber_.frames("tracker");
  for (std::size_t i = 0; i < still.size(); ++i) {
    EXPECT_TRUE(still[i].still && still[i].tracked);
    EXPECT_EQ(still[i].sequence, still[0].sequence + i);
  }
  // After a late frame on a busy computer the next one follows sooner.
  EXPECT_GT(seconds_between(still.front(), still.back()), 0.5 * static_cast<double>(still.size() - 1) - 0.55);
  feeder.stand_still(false);
  EXPECT_TRUE(comes_true([&] { return !subscriber_.frames("tracker").back().still; }));
}

TEST_F(ParticipantTest, LostPersonIsPublished) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  Feeder feeder(*sender);
  ASSERT_TRUE(frames_arrive(2));
  feeder.lose(true);
  ASSERT_TRUE(comes_true([&] { return !subscriber_.frames("tracker").back().tracked; }));
  EXPECT_EQ(subscriber_.frames("tracker").back().mask, 0U);
  ASSERT_TRUE(comes_true([&] { return subscriber_.frames("tracker").back().still; })) << "twice per second";
  feeder.lose(false);
  EXPECT_TRUE(comes_true([&] { return subscriber_.frames("tracker").back().tracked; }));
}

TEST_F(ParticipantTest, LastFrameBeforeAPauseIsPublished) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  const StreamHeader header = testing_motion::header();
  const std::vector<MotionFrame> frames = testing_motion::gesture(header, 3, /*period=*/0.4);
  sender->begin(header);
  for (std::size_t i = 0; i < 3; ++i) {  // at once: only the first may be published now
    sender->send(frames[i], 1.0 + static_cast<double>(i));
  }
  ASSERT_TRUE(comes_true([&] {
    const auto received = subscriber_.frames("tracker");
    return !received.empty() && received.back().captured == 3000;
  })) << "the newest, without another one after it";
}

TEST_F(ParticipantTest, TimesIncrease) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  const StreamHeader header = testing_motion::header();
  MotionFrame frame = testing_motion::gesture(header, 1)[0];
  sender->begin(header);
  sender->send(frame, 50.0);
  ASSERT_TRUE(frames_arrive(1));
  frame.state = TrackState::lost;  // published with the time of the last frame
  sender->send(frame, 50.0);
  ASSERT_TRUE(frames_arrive(2));
  frame.state = TrackState::tracking;
  sender->send(frame, std::nan(""));
  ASSERT_TRUE(frames_arrive(3));
  const std::vector<PoseFrame> frames = subscriber_.frames("tracker");
  EXPECT_EQ(frames[0].captured, 50'000U);
  EXPECT_FALSE(frames[1].tracked);
  EXPECT_GT(frames[1].captured, frames[0].captured);
  EXPECT_GT(frames[2].captured, frames[1].captured);
}

}  // namespace
}  // namespace telemime::meeting::test_support
