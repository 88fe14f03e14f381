// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/sender_list.h"

#include <gtest/gtest.h>

#include "telemime/core/testing_errors.h"
#include "telemime/outputs/testing_motion.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime {
namespace {

using testing_receivers::UdpReceiver;

std::string vmc(const UdpReceiver& receiver) {
  return "vmc://127.0.0.1:" + std::to_string(receiver.port());
}

std::string refusal(SenderList& list, const std::string& url) {
  return error_of(ErrorKind::usage, [&] { list.add(url); });
}

TEST(SenderList, EquivalentUrlsAreOneOutput) {
  SenderList list;
  list.add("vmc://localhost");
  EXPECT_NE(refusal(list, "vmc://localhost:39539").find("already in the list, as vmc://localhost"),
            std::string::npos);
  EXPECT_NE(refusal(list, "vmc://127.0.0.1?bundle=1"), "");
  EXPECT_EQ(list.status().size(), 1U);
  EXPECT_FALSE(list.remove("vmc://localhost:39540"));
  EXPECT_FALSE(list.remove("no URL at all"));
  EXPECT_TRUE(list.remove("vmc://127.0.0.1:39539"));
  EXPECT_TRUE(list.status().empty());
}

TEST(SenderList, SaysWhetherAnOutputIsNew) {
  SenderList list;
  EXPECT_TRUE(list.add("vmc://localhost"));
  EXPECT_TRUE(list.switch_off("vmc://localhost"));
  EXPECT_FALSE(list.add("vmc://localhost")) << "switched on again";
  EXPECT_TRUE(list.remove("vmc://localhost"));
  EXPECT_TRUE(list.add("vmc://localhost"));
}

TEST(SenderList, NothingIsSentToAnOutputThatIsOff) {
  UdpReceiver receiver;
  const StreamHeader header = testing_motion::header();
  const std::vector<MotionFrame> frames = testing_motion::gesture(header, 2);
  SenderList list;
  list.offer(vmc(receiver));
  list.person(header);
  list.send(frames[0], 0.0);
  ASSERT_EQ(list.status().size(), 1U);
  EXPECT_EQ(list.status()[0].state, SenderState::off);
  EXPECT_EQ(list.status()[0].url, vmc(receiver));

  list.add(vmc(receiver));
  EXPECT_EQ(list.status().size(), 1U);
  EXPECT_NE(list.status()[0].state, SenderState::off);
  list.send(frames[1], 0.0);
  EXPECT_TRUE(receiver.receive()) << "the person is known to one that is switched on later";
  EXPECT_TRUE(list.switch_off(vmc(receiver)));  // its sender has ended
  while (receiver.receive(0)) {
  }
  list.send(frames[0], 0.0);
  EXPECT_EQ(list.status()[0].state, SenderState::off);
  EXPECT_FALSE(receiver.receive(0));
}

TEST(SenderList, OfferDoesNotSwitchOff) {
  SenderList list;
  list.add("vmc://a");
  list.offer("vmc://b");
  list.add("vmc://b:39539");  // what an earlier run had and the command line names
  list.offer("vmc://a:39539");
  ASSERT_EQ(list.status().size(), 2U);
  EXPECT_NE(list.status()[0].state, SenderState::off);
  EXPECT_NE(list.status()[1].state, SenderState::off);
  EXPECT_THROW(list.offer("carrier-pigeon://coop"), Error);
}

TEST(SenderList, HoldsSixteenOutputs) {
  SenderList list;
  for (int i = 0; i < 16; ++i) {
    list.offer("vmc://h" + std::to_string(i));
  }
  EXPECT_NE(refusal(list, "vmc://localhost").find("16 outputs"), std::string::npos);
  EXPECT_THROW(list.offer("vmc://localhost"), Error);
  EXPECT_NO_THROW(list.add("vmc://h3"));
}

}  // namespace
}  // namespace telemime
