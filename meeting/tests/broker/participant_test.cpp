// SPDX-License-Identifier: Apache-2.0
// A sender in a room: what it tells, and how often.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "broker.h"
#include "feeder.h"
#include "meeting/protocol/messages.h"
#include "meeting/protocol/publishing.h"
#include "meeting/protocol/publishing.h"
#include "meeting/transport/senders.h"
#include "subscriber.h"
#include "telemime/outputs/numbers.h"
#include "telemime/streaming/person_motion.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting::test_support {
namespace {

using testing_receivers::comes_true;

constexpr double kMicro = 1e-6;  // s

bool is_sending(const Sender& sender) {
  return comes_true([&] { return sender.status().state == SenderState::sending; });
}

double seconds_between(const PoseFrame& first, const PoseFrame& last) {
  return static_cast<double>(last.captured - first.captured) * kMicro;
}

class MeetingTest : public ::testing::Test {
 protected:
  bool frames_come(std::size_t count) const {
    return comes_true([&] { return ear_.frames("tracker").size() >= count; });
  }
  Broker broker_;
  Subscriber ear_{broker_.port()};
};

TEST_F(MeetingTest, FramesAreWhatWasSent) {
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
    ASSERT_TRUE(frames_come(i + 1));
    const PoseFrame heard = ear_.frames("tracker").back();
    const auto meant = motion(motion.clean(frame));
    ASSERT_TRUE(meant);
    EXPECT_TRUE(heard.tracked);
    EXPECT_FALSE(heard.still);
    EXPECT_EQ(heard.sequence, i);
    EXPECT_EQ(heard.captured, static_cast<std::uint64_t>(std::llround(1000.0 * taken)));
    EXPECT_EQ(heard.mask, kTrackedBones);
    for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
      if (heard.has(bone)) {
        EXPECT_LT(heard.rotation[bone].angularDistance(meant->rotation[bone]) * kDegreesPerRadian, 0.01);
        EXPECT_EQ(heard.confidence[bone], i < 4 ? 0 : 8);
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(heard.hips[axis], 1000.0 * meant->hips[static_cast<Eigen::Index>(axis)], 0.501);
    }
  }
  const std::vector<PoseFrame> all = ear_.frames("tracker");
  for (const PoseFrame& frame : all) {
    EXPECT_EQ(frame.session, all[0].session);
  }
  EXPECT_GE(sender->status().sent, static_cast<std::int64_t>(sent.size()) - 1);
}

TEST_F(MeetingTest, StateAndPresenceAreTold) {
  const auto sender =
      make_sender(broker_.url() + "?name=J%C3%B6rg&look=robot&seat=2&participant=p07", kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  ASSERT_TRUE(comes_true([&] { return ear_.json("p/p07/state").is_object(); }));
  EXPECT_FALSE(ear_.json("p/p07/state").contains("bones")) << "there is nobody yet";
  const StreamHeader header = testing_motion::header();
  sender->begin(header);
  ASSERT_TRUE(comes_true([&] { return ear_.json("p/p07/state").contains("bones"); }));
  const auto state = read_state(ear_.newest("p/p07/state")->payload);
  const auto presence = read_presence(ear_.newest("p/p07/presence")->payload);
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

  Subscriber late(broker_.port());  // who comes later hears the same
  ASSERT_TRUE(comes_true([&] { return late.newest("p/p07/state") && late.newest("p/p07/presence"); }));
  EXPECT_EQ(late.newest("p/p07/state")->payload, ear_.newest("p/p07/state")->payload);
  EXPECT_TRUE(late.newest("p/p07/state")->retained);
  const std::vector<Subscriber::Heard> heard = late.all();
  EXPECT_TRUE(std::any_of(heard.begin(), heard.end(),
                          [](const auto& one) { return one.topic == "p/p07/presence" && one.retained; }));
}

TEST_F(MeetingTest, WithoutFramesItIsHeardOf) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  ear_.forget();
  const auto breaths = [&] {
    std::vector<double> times;  // s
    for (const Subscriber::Heard& one : ear_.all()) {
      if (one.topic == "p/tracker/presence" && !one.retained && read_presence(one.payload)->here) {
        times.push_back(one.at);
      }
    }
    return times;
  };
  ASSERT_TRUE(comes_true([&] { return breaths().size() >= 4; }));
  const std::vector<double> times = breaths();
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double gap = times[i] - times[i - 1];
    EXPECT_GT(gap, 0.5) << "no more often than needed";
    EXPECT_LT(gap, 3 * 1.25) << "nobody takes it for gone";
  }
}

TEST_F(MeetingTest, AMirroredPersonIsToldMirrored) {
  const auto plain = make_sender(broker_.url(), kAllSenderKinds);
  const auto mirrored = make_sender(broker_.url() + "?participant=mirror&mirror=1", kAllSenderKinds);
  ASSERT_TRUE(is_sending(*plain) && is_sending(*mirrored));
  const StreamHeader header = testing_motion::header();
  const MotionFrame frame = testing_motion::gesture(header, 5)[4];
  for (const auto* const sender : {&plain, &mirrored}) {
    (*sender)->begin(header);
    (*sender)->send(frame, 1.0);
  }
  ASSERT_TRUE(frames_come(1) && comes_true([&] { return !ear_.frames("mirror").empty(); }));
  const PoseFrame a = ear_.frames("tracker")[0];
  const PoseFrame b = ear_.frames("mirror")[0];
  EXPECT_NE(a.session, b.session);
  const auto left = static_cast<std::size_t>(HumanBone::l_lower_arm);
  const auto right = static_cast<std::size_t>(HumanBone::r_lower_arm);
  const Eigen::Quaterniond& q = a.rotation[left];
  const Eigen::Quaterniond other(q.w(), q.x(), -q.y(), -q.z());
  EXPECT_LT(other.angularDistance(b.rotation[right]) * kDegreesPerRadian, 0.5);
}

TEST_F(MeetingTest, TheRateFallsWhenOthersCome) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  Feeder feeder(*sender);
  // Alone: 30 a second. Nothing but a busy computer makes it less, and no fewer than 12 while nobody is here.
  ASSERT_TRUE(comes_true([&] {
    ear_.forget();
    const bool came = frames_come(31);
    const std::vector<PoseFrame> frames = ear_.frames("tracker");
    return came && seconds_between(frames[0], frames[30]) < 30.0 / 12.0;
  }));
  const std::vector<PoseFrame> alone = ear_.frames("tracker");
  EXPECT_GT(seconds_between(alone.front(), alone.back()), static_cast<double>(alone.size() - 1) / 30.0 - 0.1);

  for (int i = 1; i < 60; ++i) {
    ear_.say("p/guest" + std::to_string(i) + "/presence", write_presence({true, 1}));
  }
  ASSERT_TRUE(comes_true([&] { return sender->status().receivers == 59; })) << sender->status().receivers;
  ear_.forget();
  ASSERT_TRUE(frames_come(11));
  const std::vector<PoseFrame> crowded = ear_.frames("tracker");
  EXPECT_GT(seconds_between(crowded[0], crowded[10]), 10 / 5.0 - 0.35) << "5 a second for 60";

  for (int i = 1; i < 60; ++i) {
    ear_.say("p/guest" + std::to_string(i) + "/presence", write_presence({false, 1}));
  }
  ASSERT_TRUE(comes_true([&] { return sender->status().receivers == 0; })) << sender->status().receivers;
  ASSERT_TRUE(comes_true([&] {
    ear_.forget();
    const bool came = frames_come(31);
    const std::vector<PoseFrame> frames = ear_.frames("tracker");
    return came && seconds_between(frames[0], frames[30]) < 30.0 / 12.0;
  })) << "the rate does not rise again";
}

TEST_F(MeetingTest, NobodyMovesIsToldTwiceASecond) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  Feeder feeder(*sender);
  ASSERT_TRUE(frames_come(3));
  feeder.stand_still(true);
  ASSERT_TRUE(comes_true([&] {
    const auto frames = ear_.frames("tracker");
    return !frames.empty() && frames.back().still;
  }));
  ear_.forget();
  ASSERT_TRUE(frames_come(5));
  const std::vector<PoseFrame> still = ear_.frames("tracker");
  for (std::size_t i = 0; i < still.size(); ++i) {
    EXPECT_TRUE(still[i].still && still[i].tracked);
    EXPECT_EQ(still[i].sequence, still[0].sequence + i);
  }
  // A frame that was late on a busy computer has the next one nearer behind it.
  EXPECT_GT(seconds_between(still.front(), still.back()), 0.5 * static_cast<double>(still.size() - 1) - 0.55);
  feeder.stand_still(false);
  EXPECT_TRUE(comes_true([&] { return !ear_.frames("tracker").back().still; }));
}

TEST_F(MeetingTest, ALostPersonIsTold) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  Feeder feeder(*sender);
  ASSERT_TRUE(frames_come(2));
  feeder.lose(true);
  ASSERT_TRUE(comes_true([&] { return !ear_.frames("tracker").back().tracked; }));
  EXPECT_EQ(ear_.frames("tracker").back().mask, 0U);
  ASSERT_TRUE(comes_true([&] { return ear_.frames("tracker").back().still; })) << "twice a second";
  feeder.lose(false);
  EXPECT_TRUE(comes_true([&] { return ear_.frames("tracker").back().tracked; }));
}

TEST_F(MeetingTest, TheLastFrameBeforeAPauseGoesOut) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  const StreamHeader header = testing_motion::header();
  const std::vector<MotionFrame> frames = testing_motion::gesture(header, 3, /*period=*/0.4);
  sender->begin(header);
  for (std::size_t i = 0; i < 3; ++i) {  // at once: only the first may go now
    sender->send(frames[i], 1.0 + static_cast<double>(i));
  }
  ASSERT_TRUE(comes_true([&] {
    const auto heard = ear_.frames("tracker");
    return !heard.empty() && heard.back().captured == 3000;
  })) << "the newest, without another one behind it";
}

TEST_F(MeetingTest, TimesRise) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  const StreamHeader header = testing_motion::header();
  MotionFrame frame = testing_motion::gesture(header, 1)[0];
  sender->begin(header);
  sender->send(frame, 50.0);
  ASSERT_TRUE(frames_come(1));
  frame.state = TrackState::lost;  // left: told with the time of the last picture
  sender->send(frame, 50.0);
  ASSERT_TRUE(frames_come(2));
  frame.state = TrackState::tracking;
  sender->send(frame, std::nan(""));
  ASSERT_TRUE(frames_come(3));
  const std::vector<PoseFrame> frames = ear_.frames("tracker");
  EXPECT_EQ(frames[0].captured, 50'000U);
  EXPECT_FALSE(frames[1].tracked);
  EXPECT_GT(frames[1].captured, frames[0].captured);
  EXPECT_GT(frames[2].captured, frames[1].captured);
}

TEST_F(MeetingTest, FramesAreShort) {
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  Feeder feeder(*sender);
  ASSERT_TRUE(frames_come(5));
  for (const Subscriber::Heard& heard : ear_.all()) {
    if (heard.topic == "p/tracker/pose") {
      EXPECT_EQ(heard.payload.size(), 111U);
    }
  }
}

}  // namespace
}  // namespace telemime::meeting::test_support
