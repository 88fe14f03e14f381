// SPDX-License-Identifier: Apache-2.0
// A broker cluster whose nodes die, and participants who stop reading.
#include <gtest/gtest.h>
#include <mosquitto.h>

#include <algorithm>
#include <iostream>
#include <memory>

#include "checks.h"
#include "cluster.h"
#include "feeder.h"
#include "meeting/transport/senders.h"
#include "relay.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting::test_support {
namespace {

/// The nodes may need several seconds to elect a leader before they retain anything.
bool eventually(const std::function<bool()>& condition) {
  return comes_true(condition) || comes_true(condition) || comes_true(condition);
}

/// The longest time between two frames of a participant, s.
double longest_gap(const Subscriber& subscriber, const std::string& participant) {
  double last = 0.0;
  double longest = 0.0;
  for (const Subscriber::Received& received : subscriber.all()) {
    if (received.topic == "p/" + participant + "/pose") {
      longest = last == 0.0 ? 0.0 : std::max(longest, received.at - last);
      last = received.at;
    }
  }
  return longest;
}

class ClusterFaults : public ::testing::Test {
 protected:
  std::unique_ptr<Subscriber> subscriber_at(std::size_t node) const {
    return std::make_unique<Subscriber>(cluster_.port(node), "studio.watch", cluster_.password("watch"));
  }
  static bool hears(const Subscriber& subscriber, const std::string& participant, std::size_t count) {
    return eventually([&] { return subscriber.frames(participant).size() >= count; });
  }
  static bool knows(const Subscriber& subscriber, const std::string& participant) {
    return eventually([&] {
      const auto presence = subscriber.json("p/" + participant + "/presence");
      return presence.is_object() && presence.at("here") == true &&
             subscriber.json("p/" + participant + "/state").contains("bones");
    });
  }
  Cluster cluster_;
};

TEST_F(ClusterFaults, DeadNodeDisconnectsNobodyElse) {
  Relay name({cluster_.port(0), cluster_.port(1)});  // one address for clients, as a load balancer gives
  const auto subscriber = subscriber_at(2);
  const auto there = make_sender(cluster_.url(name.port(), "p01"), kAllSenderKinds);
  const auto elsewhere = make_sender(cluster_.url(cluster_.port(1), "p02"), kAllSenderKinds);
  const Feeder of_there(*there);
  const Feeder of_elsewhere(*elsewhere);
  ASSERT_TRUE(hears(*subscriber, "p01", 5) && hears(*subscriber, "p02", 5));
  const int made = name.made();

  cluster_.kill(0);
  const PoseFrame before = subscriber->frames("p01").back();
  const std::uint32_t last = subscriber->frames("p02").back().sequence;
  EXPECT_TRUE(eventually([&] { return subscriber->frames("p02").back().sequence >= last + 30; }));
  EXPECT_EQ(elsewhere->status().state, SenderState::sending) << elsewhere->status().words;
  const std::vector<PoseFrame> frames = subscriber->frames("p02");
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].sequence, frames[i - 1].sequence + 1) << "nothing of the others is lost";
  }

  ASSERT_TRUE(eventually([&] { return subscriber->frames("p01").back().sequence > before.sequence; }))
      << there->status().words;
  EXPECT_EQ(subscriber->frames("p01").back().session, before.session) << "the publisher is the same";
  EXPECT_GT(name.made(), made) << "by another node";
  std::cout << "the longest gap: " << longest_gap(*subscriber, "p02") << " s for those at other nodes, "
            << longest_gap(*subscriber, "p01") << " s for those of the one that died\n";
  EXPECT_TRUE(knows(*subscriber, "p01"));
  const auto late = subscriber_at(1);
  EXPECT_TRUE(knows(*late, "p01") && knows(*late, "p02")) << "two nodes are enough to keep what is retained";

  cluster_.start(0);
  const auto back = subscriber_at(0);
  EXPECT_TRUE(knows(*back, "p01") && knows(*back, "p02"));
  EXPECT_TRUE(hears(*back, "p01", 5) && hears(*back, "p02", 5));
}

TEST_F(ClusterFaults, LastNodeStillDeliversPoses) {
  const auto subscriber = subscriber_at(2);
  const auto sender = make_sender(cluster_.url(cluster_.port(2), "p01"), kAllSenderKinds);
  const Feeder feeder(*sender);
  ASSERT_TRUE(hears(*subscriber, "p01", 5));
  cluster_.kill(0);
  cluster_.kill(1);
  const std::size_t count = subscriber->frames("p01").size();
  EXPECT_TRUE(hears(*subscriber, "p01", count + 60));
  EXPECT_EQ(sender->status().state, SenderState::sending) << sender->status().words;
  cluster_.start(0);
  const auto late = subscriber_at(0);
  EXPECT_TRUE(knows(*late, "p01"));
  EXPECT_TRUE(hears(*late, "p01", 5));
}

/// A client that stops reading after its subscription.
class Stalled {
 public:
  Stalled(const Cluster& cluster, std::size_t node) : client_(mosquitto_new(nullptr, true, &granted_)) {
    mosquitto_subscribe_callback_set(
        client_, [](mosquitto* /*client*/, void* self, int /*id*/, int /*count*/, const int* /*granted*/) {
          *static_cast<bool*>(self) = true;
        });
    mosquitto_username_pw_set(client_, "studio.watch", cluster.password("watch").c_str());
    EXPECT_EQ(mosquitto_connect(client_, "127.0.0.1", cluster.port(node), 600), MOSQ_ERR_SUCCESS);
    bool asked = false;
    EXPECT_TRUE(eventually([&] {
      if (mosquitto_loop(client_, 10, 1) == MOSQ_ERR_SUCCESS && !asked) {
        asked = mosquitto_subscribe(client_, nullptr, "r/home/studio/#", 0) == MOSQ_ERR_SUCCESS;
      }
      return granted_;
    }));
  }
  Stalled(const Stalled&) = delete;
  Stalled& operator=(const Stalled&) = delete;
  ~Stalled() { mosquitto_destroy(client_); }

 private:
  bool granted_ = false;
  mosquitto* client_;
};

TEST_F(ClusterFaults, SlowReaderIsDisconnectedAlone) {
  const auto subscriber = subscriber_at(2);
  const auto sender = make_sender(cluster_.url(cluster_.port(0), "p01"), kAllSenderKinds);
  const Feeder feeder(*sender);
  ASSERT_TRUE(hears(*subscriber, "p01", 5));
  const Stalled stalled(cluster_, 1);
  Subscriber loud(cluster_.port(0), "studio.service", cluster_.password("service"));
  ASSERT_TRUE(hears(loud, "p01", 1));
  const std::string page(60000, 'x');
  const auto disconnected = [&] { return cluster_.log(1).find("Slow Consumer") != std::string::npos; };
  EXPECT_TRUE(eventually([&] {
    loud.publish("p/p02/board/0", page);  // kernel buffers take some megabytes before the node notices
    loud.clear();
    return disconnected();
  }));
  const std::size_t count = subscriber->frames("p01").size();
  EXPECT_TRUE(hears(*subscriber, "p01", count + 30));
  EXPECT_EQ(sender->status().state, SenderState::sending) << sender->status().words;
}

}  // namespace
}  // namespace telemime::meeting::test_support
