// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/frame_exchange.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

namespace telemime {
namespace {

// What the search side is given, until all is to stop.
std::vector<std::int64_t> taken_from(FrameExchange& exchange, bool settled) {
  std::vector<std::int64_t> taken;
  while (LiveSlot* const slot = exchange.take()) {
    taken.push_back(slot->times.index);
    slot->times.index = -1;
    exchange.done(settled);
  }
  return taken;
}

TEST(FrameExchange, PassesAllInTheirOrder) {
  for (const bool settled : {false, true}) {
    FrameExchange exchange;
    std::vector<std::int64_t> taken;
    std::thread search([&] { taken = taken_from(exchange, settled); });
    constexpr std::int64_t kCount = 2000;
    for (std::int64_t i = 0; i < kCount; ++i) {
      LiveSlot* const slot = exchange.free_slot();
      ASSERT_NE(slot, nullptr);
      slot->times.index = i;
      exchange.publish();
    }
    ASSERT_TRUE(exchange.wait_for_search());
    EXPECT_EQ(exchange.calibrated(), settled);
    exchange.finish();
    search.join();
    ASSERT_EQ(taken.size(), static_cast<std::size_t>(kCount));
    for (std::int64_t i = 0; i < kCount; ++i) {
      EXPECT_EQ(taken[static_cast<std::size_t>(i)], i);
    }
  }
}

TEST(FrameExchange, ASettledPersonLetsBothSidesWorkAtOnce) {
  FrameExchange exchange;
  exchange.set_calibrated(true);
  LiveSlot* const first = exchange.free_slot();
  exchange.publish();
  EXPECT_EQ(exchange.take(), first);
  LiveSlot* const second = exchange.free_slot();  // while the first is being searched
  ASSERT_NE(second, nullptr);
  EXPECT_NE(second, first);
}

TEST(FrameExchange, WhatWasGivenIsDealtWithBeforeTheEnd) {
  FrameExchange exchange;
  LiveSlot* const slot = exchange.free_slot();
  exchange.publish();
  exchange.finish();
  EXPECT_EQ(exchange.free_slot(), nullptr);
  EXPECT_EQ(exchange.take(), slot);
  exchange.done(false);
  EXPECT_EQ(exchange.take(), nullptr);
  EXPECT_FALSE(exchange.stopping());
}

TEST(FrameExchange, StopEndsEveryWait) {
  FrameExchange exchange;
  ASSERT_NE(exchange.free_slot(), nullptr);
  std::thread search([&] {
    EXPECT_NE(exchange.take(), nullptr);
    EXPECT_EQ(exchange.take(), nullptr);  // nothing more is given, and the search is never done
  });
  exchange.publish();
  std::thread image([&] { EXPECT_EQ(exchange.free_slot(), nullptr); });
  std::thread other([&] { EXPECT_FALSE(exchange.wait_for_search()); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // by now all of them wait
  exchange.stop();
  search.join();
  image.join();
  other.join();
  EXPECT_TRUE(exchange.stopping());
  EXPECT_EQ(exchange.take(), nullptr);
}

}  // namespace
}  // namespace telemime
