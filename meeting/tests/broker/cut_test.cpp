// SPDX-License-Identifier: Apache-2.0
// A network that is cut between a tracker and its broker, so that packets do not arrive; and a receiver that
// is off.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "broker.h"
#include "checks.h"
#include "cut_network.h"
#include "feeder.h"
#include "meeting/transport/senders.h"
#include "tracker_process.h"

namespace telemime::meeting::test_support {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
constexpr double kMicro = 1e-6;  // s
constexpr std::chrono::seconds kCut{10};
/// 1.5 times the keep-alive of 5 s, then 5 s until Mosquitto checks, and a margin for a busy computer.
constexpr double kLongestUntilGone = 5.0 * 1.5 + 5.0 + 3.0;  // s
constexpr double kLate = 2.0;  // s: a frame that is older was taken while the network was cut

double seconds(steady_clock::time_point time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

class NetworkTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = CutNetwork::missing(); !missing.empty()) {
      ASSERT_EQ(std::getenv("CI"), nullptr) << missing;
      GTEST_SKIP() << missing;
    }
  }
};

class CutNetworkTest : public NetworkTest {
 protected:
  static std::string url(const Broker& broker) {
    return "mqtt://" + CutNetwork::broker() + ":" + std::to_string(broker.port()) + "/home/studio";
  }
};

using Unreachable = NetworkTest;

TEST_F(CutNetworkTest, TenSecondsWithoutANetwork) {
  CutNetwork network;
  const Broker broker(Broker::Where::everywhere);
  Subscriber subscriber(broker.port());
  const TrackerProcess tracker(url(broker), network.at_tracker());
  ASSERT_TRUE(comes_true([&] { return subscriber.frames("tracker").size() >= 10; })) << tracker.output();
  const PoseFrame before = subscriber.frames("tracker").back();
  network.cut();
  const auto cut = steady_clock::now();
  ASSERT_TRUE(comes_true([&] { return steady_clock::now() >= cut + kCut; }));
  subscriber.clear();
  network.mend();
  const auto mended = steady_clock::now();
  ASSERT_TRUE(comes_true([&] { return subscriber.frames("tracker").size() >= 60; })) << tracker.output();
  const std::vector<PoseFrame> frames = subscriber.frames("tracker");
  EXPECT_EQ(frames[0].session, before.session);
  EXPECT_GT(frames[0].sequence, before.sequence);
  double most = 0.0;
  double first = 0.0;
  for (const Subscriber::Received& received : subscriber.all()) {
    if (received.topic != "p/tracker/pose") {
      continue;
    }
    const PoseFrame frame = frame_of(received.payload);
    first = first == 0.0 ? received.at : first;
    most = std::max(most, received.at - static_cast<double>(frame.captured) * kMicro);
  }
  EXPECT_LT(most, kLate) << "no frame from the interruption arrives afterwards";
  std::cout << "frames again " << first - seconds(mended) << " s after the cable was mended, none older than "
            << 1000.0 * most << " ms\n";
  // The last will may arrive only now; the tracker contradicts it.
  ASSERT_TRUE(comes_true([&] { return seconds(steady_clock::now()) > seconds(cut) + kLongestUntilGone; }));
  EXPECT_TRUE(is_here(subscriber, "tracker", true));
}

TEST_F(CutNetworkTest, TrackerThatDiesBehindACutIsGone) {
  CutNetwork network;
  const Broker broker(Broker::Where::everywhere);
  const Subscriber subscriber(broker.port());
  TrackerProcess tracker(url(broker), network.at_tracker());
  ASSERT_TRUE(comes_true([&] { return subscriber.frames("tracker").size() >= 10; })) << tracker.output();
  network.cut();
  const double cut = seconds(steady_clock::now());
  tracker.kill();
  ASSERT_TRUE(is_here(subscriber, "tracker", false));
  const double gone = subscriber.newest("p/tracker/presence")->at - cut;
  EXPECT_LT(gone, kLongestUntilGone);
  std::cout << "gone " << gone << " s after the cut\n";
}

// Many small datagrams fill the system's queue for an address that it cannot resolve.
TEST_F(Unreachable, ComputerThatIsOffIsReported) {
  const CutNetwork network;
  for (const char* const options : {"", "?bundle=0"}) {
    const auto sender = make_sender(std::string("vmc://10.77.0.77:39539") + options, kAllSenderKinds);
    const Feeder feeder(*sender);
    EXPECT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; })) << options;
    for (const auto end = steady_clock::now() + std::chrono::seconds(4);
         steady_clock::now() < end;) {  // the next attempt's, too
      ASSERT_EQ(sender->status().words, "that computer cannot be reached from here; trying again") << options;
      std::this_thread::sleep_for(milliseconds(5));
    }
  }
}

}  // namespace
}  // namespace telemime::meeting::test_support
