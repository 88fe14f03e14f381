// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/hand_over.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

namespace telemime {
namespace {

// What the search side is given, until all is to stop.
std::vector<std::int64_t> taken_from(HandOver& hand_over, bool settled) {
  std::vector<std::int64_t> taken;
  while (LiveSlot* const slot = hand_over.take()) {
    taken.push_back(slot->times.index);
    slot->times.index = -1;
    hand_over.done(settled);
  }
  return taken;
}

TEST(HandOver, PassesAllInTheirOrder) {
  for (const bool settled : {false, true}) {
    HandOver hand_over;
    std::vector<std::int64_t> taken;
    std::thread search([&] { taken = taken_from(hand_over, settled); });
    constexpr std::int64_t kCount = 2000;
    for (std::int64_t i = 0; i < kCount; ++i) {
      LiveSlot* const slot = hand_over.begin();
      ASSERT_NE(slot, nullptr);
      slot->times.index = i;
      hand_over.give();
    }
    ASSERT_TRUE(hand_over.wait_for_search());
    EXPECT_EQ(hand_over.settled(), settled);
    hand_over.finish();
    search.join();
    ASSERT_EQ(taken.size(), static_cast<std::size_t>(kCount));
    for (std::int64_t i = 0; i < kCount; ++i) {
      EXPECT_EQ(taken[static_cast<std::size_t>(i)], i);
    }
  }
}

TEST(HandOver, ASettledPersonLetsBothSidesWorkAtOnce) {
  HandOver hand_over;
  hand_over.set_settled(true);
  LiveSlot* const first = hand_over.begin();
  hand_over.give();
  EXPECT_EQ(hand_over.take(), first);
  LiveSlot* const second = hand_over.begin();  // while the first is being searched
  ASSERT_NE(second, nullptr);
  EXPECT_NE(second, first);
}

TEST(HandOver, WhatWasGivenIsDealtWithBeforeTheEnd) {
  HandOver hand_over;
  LiveSlot* const slot = hand_over.begin();
  hand_over.give();
  hand_over.finish();
  EXPECT_EQ(hand_over.begin(), nullptr);
  EXPECT_EQ(hand_over.take(), slot);
  hand_over.done(false);
  EXPECT_EQ(hand_over.take(), nullptr);
  EXPECT_FALSE(hand_over.stopping());
}

TEST(HandOver, StopEndsEveryWait) {
  HandOver hand_over;
  ASSERT_NE(hand_over.begin(), nullptr);
  std::thread search([&] {
    EXPECT_NE(hand_over.take(), nullptr);
    EXPECT_EQ(hand_over.take(), nullptr);  // nothing more is given, and the search is never done
  });
  hand_over.give();
  std::thread image([&] { EXPECT_EQ(hand_over.begin(), nullptr); });
  std::thread other([&] { EXPECT_FALSE(hand_over.wait_for_search()); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // by now all of them wait
  hand_over.stop();
  search.join();
  image.join();
  other.join();
  EXPECT_TRUE(hand_over.stopping());
  EXPECT_EQ(hand_over.take(), nullptr);
}

}  // namespace
}  // namespace telemime
