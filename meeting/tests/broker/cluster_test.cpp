// SPDX-License-Identifier: Apache-2.0
// Meetings on a broker cluster: trackers at one node, subscribers at another.
#include "cluster.h"
#include "meeting/transport/senders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "checks.h"
#include "feeder.h"
#include "meeting/protocol/messages.h"
#include "relay.h"

namespace telemime::meeting::test_support {
namespace {

class ClusterMeeting : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { cluster_ = std::make_unique<Cluster>(); }
  static void TearDownTestSuite() { cluster_.reset(); }

  static std::unique_ptr<Sender> sender_at(std::size_t node, const std::string& account) {
    return make_sender(cluster_->url(cluster_->port(node), account), kAllSenderKinds);
  }
  static std::unique_ptr<Subscriber> subscriber_at(std::size_t node, const std::string& account = "watch") {
    return std::make_unique<Subscriber>(cluster_->port(node), "studio." + account,
                                        cluster_->password(account));
  }
  static std::unique_ptr<Cluster> cluster_;
};
std::unique_ptr<Cluster> ClusterMeeting::cluster_;

TEST_F(ClusterMeeting, FramesReachOtherNodes) {
  const auto subscriber = subscriber_at(2);
  const auto sender = sender_at(0, "p01");
  const Feeder feeder(*sender);
  ASSERT_TRUE(comes_true([&] { return subscriber->frames("p01").size() >= 20; })) << sender->status().words;
  const std::vector<PoseFrame> frames = subscriber->frames("p01");
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].sequence, frames[i - 1].sequence + 1);
    EXPECT_GT(frames[i].captured, frames[i - 1].captured);
  }
}

TEST_F(ClusterMeeting, LateSubscriberGetsRetainedMessages) {
  const auto first = subscriber_at(2);
  const auto sender = sender_at(0, "p02");
  const Feeder feeder(*sender);
  ASSERT_TRUE(is_here(*first, "p02", true)) << sender->status().words;
  ASSERT_TRUE(comes_true([&] { return first->json("p/p02/state").contains("bones"); }));
  const auto late = subscriber_at(1);
  ASSERT_TRUE(comes_true([&] { return late->newest("p/p02/state") && late->newest("p/p02/presence"); }));
  EXPECT_TRUE(late->newest("p/p02/state")->retained);
  const std::vector<Subscriber::Received> received = late->all();  // a sign of life may have followed
  EXPECT_TRUE(std::any_of(received.begin(), received.end(),
                          [](const auto& one) { return one.topic == "p/p02/presence" && one.retained; }));
  EXPECT_EQ(late->newest("p/p02/state")->payload, first->newest("p/p02/state")->payload);
  EXPECT_TRUE(comes_true([&] { return !late->frames("p02").empty(); }));
}

// One after the other, as in all tests here: with simultaneous clients, nats-server 2.9 sometimes loses a
// retained message.
TEST_F(ClusterMeeting, ParticipantsAtAllNodesAreCounted) {
  std::vector<std::unique_ptr<Sender>> senders;
  for (std::size_t node = 0; node < Cluster::kNodes; ++node) {
    senders.push_back(sender_at(node, "p0" + std::to_string(3 + node)));
    ASSERT_TRUE(is_sending(*senders.back())) << senders.back()->status().words;
  }
  for (const auto& sender : senders) {
    EXPECT_TRUE(comes_true([&] { return sender->status().receivers == 2; })) << sender->status().receivers;
  }
}

TEST_F(ClusterMeeting, LastWillReachesTheOtherNodes) {
  const auto subscriber = subscriber_at(2);
  Relay relay(cluster_->port(0));
  const auto sender = make_sender(cluster_->url(relay.port(), "p06"), kAllSenderKinds);
  ASSERT_TRUE(is_here(*subscriber, "p06", true) && is_sending(*sender)) << sender->status().words;
  const std::uint16_t session = subscriber->json("p/p06/presence").at("session");
  relay.cut_sender();
  relay.cut_broker();
  EXPECT_TRUE(was_published(*subscriber, "p/p06/presence", write_presence({false, session})));
  EXPECT_TRUE(is_here(*subscriber, "p06", true)) << "and then they are back";
}

TEST_F(ClusterMeeting, ProperEndLeavesNothingBehind) {
  const auto subscriber = subscriber_at(1);
  {
    const auto sender = sender_at(0, "p07");
    ASSERT_TRUE(is_here(*subscriber, "p07", true)) << sender->status().words;
  }
  EXPECT_TRUE(is_here(*subscriber, "p07", false));
  EXPECT_TRUE(comes_true([&] { return subscriber->newest("p/p07/state")->payload.empty(); }));
  // Nodes tell each other what is kept, and what no longer is, in their own time.
  EXPECT_TRUE(comes_true([&] {
    const auto late = subscriber_at(2);
    return comes_true([&] { return late->newest("p/p07/presence").has_value(); }) &&
           !late->newest("p/p07/state");
  })) << "nothing is kept of it";
}

TEST_F(ClusterMeeting, ForbiddenPublishingIsReported) {
  const auto subscriber = subscriber_at(2);
  const auto sender =
      make_sender(cluster_->url(cluster_->port(0), "p08") + "?participant=p01", kAllSenderKinds);
  ASSERT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; }));
  EXPECT_NE(sender->status().words.find("the account may not publish as"), std::string::npos)
      << sender->status().words;
  const auto liar = subscriber_at(1, "p08");
  ASSERT_TRUE(comes_true([&] { return !liar->all().empty(); })) << "it may read";
  liar->publish("p/p01/presence", "forged");
  liar->publish("room", "forged");
  liar->publish("p/p08/chat", "may be said");
  EXPECT_TRUE(was_published(*subscriber, "p/p08/chat", "may be said"));
  for (const Subscriber::Received& received : subscriber->all()) {
    EXPECT_NE(received.payload, "forged") << received.topic;
  }
  EXPECT_NE(cluster_->log(1).find("Publish Violation"), std::string::npos);
}

TEST_F(ClusterMeeting, OtherMeetingsAreForbidden) {
  std::string url = cluster_->url(cluster_->port(1), "p01");
  url.replace(url.rfind("studio"), 6, "office");
  const auto sender = make_sender(url + "?participant=p01", kAllSenderKinds);
  ASSERT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; }));
  EXPECT_NE(sender->status().words.find("may not read the meeting"), std::string::npos)
      << sender->status().words;
}

TEST_F(ClusterMeeting, WrongPasswordIsReported) {
  const auto sender =
      make_sender("mqtt://studio.p01:guess@127.0.0.1:" + std::to_string(cluster_->port(2)) + "/home/studio",
                  kAllSenderKinds);
  ASSERT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; }));
  EXPECT_NE(sender->status().words.find("rejects the user name or password"), std::string::npos)
      << sender->status().words;
}

}  // namespace
}  // namespace telemime::meeting::test_support
