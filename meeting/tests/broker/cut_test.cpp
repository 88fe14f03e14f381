// SPDX-License-Identifier: Apache-2.0
// A network that is cut between a tracker and its broker: nobody is told, packets just do not arrive.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "broker.h"
#include "cut_network.h"
#include "subscriber.h"
#include "telemime/streaming/testing_receivers.h"
#include "tracker_process.h"

namespace telemime::meeting::test_support {
namespace {

using std::chrono::steady_clock;
using testing_receivers::comes_true;

constexpr double kMicro = 1e-6;  // s
constexpr std::chrono::seconds kCut{10};
/// The keep-alive of 5 s, half as long again, and 5 s: so often Mosquitto looks. The rest is for a busy
/// computer.
constexpr double kLongestUntilGone = 5.0 * 1.5 + 5.0 + 3.0;  // s
constexpr double kLate = 2.0;  // s: a frame that is older was taken while the network was cut

double seconds(steady_clock::time_point time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

class CutNetworkTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = CutNetwork::missing(); !missing.empty()) {
      ASSERT_EQ(std::getenv("CI"), nullptr) << missing;
      GTEST_SKIP() << missing;
    }
  }
  static std::string url(const Broker& broker) {
    return "mqtt://" + CutNetwork::broker() + ":" + std::to_string(broker.port()) + "/home/studio";
  }
  static bool says_here(const Subscriber& ear, bool here) {
    return comes_true([&] {
      const auto presence = ear.json("p/tracker/presence");
      return presence.is_object() && presence.at("here") == here;
    });
  }
};

TEST_F(CutNetworkTest, TenSecondsWithoutANetwork) {
  CutNetwork network;
  const Broker broker(Broker::Where::everywhere);
  Subscriber ear(broker.port());
  const TrackerProcess tracker(url(broker), network.at_tracker());
  ASSERT_TRUE(comes_true([&] { return ear.frames("tracker").size() >= 10; })) << tracker.output();
  const PoseFrame before = ear.frames("tracker").back();
  network.cut();
  const auto cut = steady_clock::now();
  ASSERT_TRUE(comes_true([&] { return steady_clock::now() >= cut + kCut; }));
  ear.forget();
  network.mend();
  const auto mended = steady_clock::now();
  ASSERT_TRUE(comes_true([&] { return ear.frames("tracker").size() >= 60; })) << tracker.output();
  const std::vector<PoseFrame> frames = ear.frames("tracker");
  EXPECT_EQ(frames[0].session, before.session);
  EXPECT_GT(frames[0].sequence, before.sequence);
  double most = 0.0;
  double first = 0.0;
  for (const Subscriber::Heard& heard : ear.all()) {
    if (heard.topic != "p/tracker/pose") {
      continue;
    }
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(heard.payload.data());
    const auto frame = decode_pose_frame({bytes, heard.payload.size()});
    ASSERT_TRUE(frame);
    first = first == 0.0 ? heard.at : first;
    most = std::max(most, heard.at - static_cast<double>(frame->captured) * kMicro);
  }
  EXPECT_LT(most, kLate) << "nothing of the time in between is said afterwards";
  std::cout << "frames again " << first - seconds(mended) << " s after the cable was mended, none older than "
            << 1000.0 * most << " ms\n";
  // The last will may come only now; it is contradicted.
  ASSERT_TRUE(comes_true([&] { return seconds(steady_clock::now()) > seconds(cut) + kLongestUntilGone; }));
  EXPECT_TRUE(says_here(ear, true));
}

TEST_F(CutNetworkTest, ATrackerThatDiesBehindACutIsGone) {
  CutNetwork network;
  const Broker broker(Broker::Where::everywhere);
  const Subscriber ear(broker.port());
  TrackerProcess tracker(url(broker), network.at_tracker());
  ASSERT_TRUE(comes_true([&] { return ear.frames("tracker").size() >= 10; })) << tracker.output();
  network.cut();
  const double cut = seconds(steady_clock::now());
  tracker.kill();
  ASSERT_TRUE(says_here(ear, false));
  const double gone = ear.newest("p/tracker/presence")->at - cut;
  EXPECT_LT(gone, kLongestUntilGone);
  std::cout << "gone " << gone << " s after the cut\n";
}

}  // namespace
}  // namespace telemime::meeting::test_support
