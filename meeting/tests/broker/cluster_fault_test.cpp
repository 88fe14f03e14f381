// SPDX-License-Identifier: Apache-2.0
// A broker cluster whose nodes die, and participants who stop reading.
#include <gtest/gtest.h>
#include <mosquitto.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include "cluster.h"
#include "feeder.h"
#include "meeting/transport/senders.h"
#include "relay.h"
#include "subscriber.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting::test_support {
namespace {

/// The nodes may need several seconds to find a leader before they keep anything.
bool comes_true(const std::function<bool()>& condition) {
  return testing_receivers::comes_true(condition) || testing_receivers::comes_true(condition) ||
         testing_receivers::comes_true(condition);
}

/// The longest time between two frames of a participant, s.
double longest_gap(const Subscriber& ear, const std::string& participant) {
  double last = 0.0;
  double longest = 0.0;
  for (const Subscriber::Heard& heard : ear.all()) {
    if (heard.topic == "p/" + participant + "/pose") {
      longest = last == 0.0 ? 0.0 : std::max(longest, heard.at - last);
      last = heard.at;
    }
  }
  return longest;
}

class ClusterFaults : public ::testing::Test {
 protected:
  std::unique_ptr<Subscriber> ear_at(std::size_t node) const {
    auto ear = std::make_unique<Subscriber>(cluster_.port(node), "studio.watch", cluster_.password("watch"));
    EXPECT_TRUE(comes_true([&] { return ear->listens(); }));
    return ear;
  }
  static bool hears(const Subscriber& ear, const std::string& participant, std::size_t count) {
    return comes_true([&] { return ear.frames(participant).size() >= count; });
  }
  static bool knows(const Subscriber& ear, const std::string& participant) {
    return comes_true([&] {
      const auto presence = ear.json("p/" + participant + "/presence");
      return presence.is_object() && presence.at("here") == true &&
             ear.json("p/" + participant + "/state").contains("bones");
    });
  }
  Cluster cluster_;
};

TEST_F(ClusterFaults, ANodeThatDiesTakesNobodyWithIt) {
  Relay name({cluster_.port(0), cluster_.port(1)});  // one address for clients, as a load balancer gives
  const auto ear = ear_at(2);
  const auto there = make_sender(cluster_.url(name.port(), "p01"), kAllSenderKinds);
  const auto elsewhere = make_sender(cluster_.url(cluster_.port(1), "p02"), kAllSenderKinds);
  const Feeder of_there(*there);
  const Feeder of_elsewhere(*elsewhere);
  ASSERT_TRUE(hears(*ear, "p01", 5) && hears(*ear, "p02", 5));
  const int made = name.made();

  cluster_.kill(0);
  const PoseFrame before = ear->frames("p01").back();
  const std::uint32_t last = ear->frames("p02").back().sequence;
  EXPECT_TRUE(comes_true([&] { return ear->frames("p02").back().sequence >= last + 30; }));
  EXPECT_EQ(elsewhere->status().state, SenderState::sending) << elsewhere->status().words;
  const std::vector<PoseFrame> frames = ear->frames("p02");
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].sequence, frames[i - 1].sequence + 1) << "nothing of the others is lost";
  }

  ASSERT_TRUE(comes_true([&] { return ear->frames("p01").back().sequence > before.sequence; }))
      << there->status().words;
  EXPECT_EQ(ear->frames("p01").back().session, before.session) << "the publisher is the same";
  EXPECT_GT(name.made(), made) << "by another node";
  std::cout << "the longest gap: " << longest_gap(*ear, "p02") << " s for those at other nodes, "
            << longest_gap(*ear, "p01") << " s for those of the one that died\n";
  EXPECT_TRUE(knows(*ear, "p01"));
  const auto late = ear_at(1);
  EXPECT_TRUE(knows(*late, "p01") && knows(*late, "p02")) << "two nodes are enough to keep what is retained";

  cluster_.start(0);
  const auto back = ear_at(0);
  EXPECT_TRUE(knows(*back, "p01") && knows(*back, "p02"));
  EXPECT_TRUE(hears(*back, "p01", 5) && hears(*back, "p02", 5));
}

TEST_F(ClusterFaults, TheLastNodeStillPassesPosesOn) {
  const auto ear = ear_at(2);
  const auto sender = make_sender(cluster_.url(cluster_.port(2), "p01"), kAllSenderKinds);
  const Feeder feeder(*sender);
  ASSERT_TRUE(hears(*ear, "p01", 5));
  cluster_.kill(0);
  cluster_.kill(1);
  const std::size_t count = ear->frames("p01").size();
  EXPECT_TRUE(hears(*ear, "p01", count + 60));
  EXPECT_EQ(sender->status().state, SenderState::sending) << sender->status().words;
  cluster_.start(0);
  const auto late = ear_at(0);
  EXPECT_TRUE(knows(*late, "p01"));
  EXPECT_TRUE(hears(*late, "p01", 5));
}

/// Takes part and reads nothing after its subscription was granted.
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
    EXPECT_TRUE(comes_true([&] {
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

TEST_F(ClusterFaults, WhoStopsReadingIsDisconnectedAndHoldsNobodyUp) {
  const auto ear = ear_at(2);
  const auto sender = make_sender(cluster_.url(cluster_.port(0), "p01"), kAllSenderKinds);
  const Feeder feeder(*sender);
  ASSERT_TRUE(hears(*ear, "p01", 5));
  const Stalled stalled(cluster_, 1);
  Subscriber loud(cluster_.port(0), "studio.service", cluster_.password("service"));
  ASSERT_TRUE(hears(loud, "p01", 1));
  const std::string page(60000, 'x');
  const auto disconnected = [&] { return cluster_.log(1).find("Slow Consumer") != std::string::npos; };
  EXPECT_TRUE(comes_true([&] {
    loud.say("p/p02/board/0", page);  // kernel buffers take some megabytes before the node notices
    loud.forget();
    return disconnected();
  }));
  const std::size_t count = ear->frames("p01").size();
  EXPECT_TRUE(hears(*ear, "p01", count + 30));
  EXPECT_EQ(sender->status().state, SenderState::sending) << sender->status().words;
}

}  // namespace
}  // namespace telemime::meeting::test_support
