// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_queue.h"

#include <gtest/gtest.h>

namespace telemime {
namespace {

WebMessage say(int topic, const std::string& words) {
  return {topic, false, std::make_shared<const std::string>(words)};
}

std::string all_of(WebQueue& queue) {
  std::string all;
  while (const std::optional<WebMessage> message = queue.pop()) {
    all += *message->bytes + " ";
  }
  return all;
}

TEST(WebQueue, OfATopicTheNewestWaits) {
  WebQueue queue;
  queue.push(say(1, "a1"));
  queue.push(say(2, "b1"));
  queue.push(say(1, "a2"));
  queue.push(say(1, "a3"));
  EXPECT_EQ(queue.size(), 2U);
  EXPECT_EQ(all_of(queue), "a3 b1 ");
}

TEST(WebQueue, ABusyTopicDoesNotStarveAnother) {
  WebQueue queue;
  std::string taken;
  for (int i = 0; i < 6; ++i) {  // two come for each that goes
    queue.push(say(1, "a"));
    queue.push(say(2, "b"));
    taken += *queue.pop()->bytes;
  }
  EXPECT_EQ(taken, "ababab");
}

TEST(WebQueue, ImportantOnesAllWaitInOrderAndGoFirst) {
  WebQueue queue;
  queue.push(say(3, "c"));
  queue.push(say(0, "x"));
  queue.push(say(0, "y"));
  EXPECT_EQ(all_of(queue), "x y c ");
}

TEST(WebQueue, TooManyImportantOnesAreRefused) {
  WebQueue queue;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(queue.push(say(0, "x")));
  }
  EXPECT_FALSE(queue.push(say(0, "x")));
  EXPECT_TRUE(queue.push(say(1, "a")));
  EXPECT_EQ(queue.size(), 1001U);
  queue.pop();
  EXPECT_TRUE(queue.push(say(0, "x")));
}

TEST(WebQueue, ATopicCanBeOff) {
  WebQueue queue;
  queue.push(say(1, "a1"));
  queue.push(say(2, "b1"));
  queue.set_topic(1, false);
  queue.set_topic(0, false);
  queue.push(say(1, "a2"));
  queue.push(say(0, "x"));
  EXPECT_EQ(all_of(queue), "x b1 ");
  queue.set_topic(1, true);
  queue.push(say(1, "a3"));
  EXPECT_EQ(all_of(queue), "a3 ");
}

}  // namespace
}  // namespace telemime
