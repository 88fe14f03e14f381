// SPDX-License-Identifier: Apache-2.0
// A receiver's computer that is off: its address is in the network, but nobody answers for it.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "cut_network.h"
#include "feeder.h"
#include "meeting/transport/senders.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting::test_support {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing_receivers::comes_true;

class Unreachable : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = CutNetwork::missing(); !missing.empty()) {
      ASSERT_EQ(std::getenv("CI"), nullptr) << missing;
      GTEST_SKIP() << missing;
    }
  }
};

// Many small datagrams fill what the system keeps for an address that it is still looking for.
TEST_F(Unreachable, AComputerThatIsOffIsToldByThatName) {
  const CutNetwork network;
  for (const char* const options : {"", "?bundle=0"}) {
    const auto sender = make_sender(std::string("vmc://10.77.0.77:39539") + options, kAllSenderKinds);
    const Feeder feeder(*sender);
    EXPECT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; })) << options;
    for (const auto end = steady_clock::now() + seconds(4);
         steady_clock::now() < end;) {  // the next attempt's, too
      ASSERT_EQ(sender->status().words, "that computer cannot be reached from here; trying again") << options;
      std::this_thread::sleep_for(milliseconds(5));
    }
  }
}

}  // namespace
}  // namespace telemime::meeting::test_support
