// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/who_is_here.h"

#include <gtest/gtest.h>

#include "meeting/protocol/room_messages.h"

namespace telemime {
namespace {

TEST(WhoIsHere, CountsWhoCameAndDidNotLeave) {
  WhoIsHere here;
  EXPECT_EQ(here.count(), 0U);
  here.heard("a", write_presence({true, 1}));
  here.heard("b", write_presence({true, 1}));
  here.heard("a", write_presence({true, 1}));
  EXPECT_EQ(here.count(), 2U);
  EXPECT_TRUE(here.has("a"));
  here.heard("a", write_presence({false, 1}));
  EXPECT_EQ(here.count(), 1U);
  EXPECT_FALSE(here.has("a"));
  here.heard("b", "");
  EXPECT_EQ(here.count(), 0U);
}

TEST(WhoIsHere, TheEndOfAnOlderSessionRemovesNobody) {
  WhoIsHere here;
  here.heard("a", write_presence({true, 1}));
  here.heard("a", write_presence({true, 2}));
  here.heard("a", write_presence({false, 1}));
  EXPECT_TRUE(here.has("a"));
  here.heard("a", write_presence({false, 2}));
  EXPECT_FALSE(here.has("a"));
  here.heard("b", write_presence({false, 1}));
  EXPECT_EQ(here.count(), 0U);
}

TEST(WhoIsHere, RubbishChangesNothing) {
  WhoIsHere here;
  here.heard("a", write_presence({true, 1}));
  here.heard("a", "gone!");
  here.heard("b", "{}");
  EXPECT_EQ(here.count(), 1U);
}

TEST(WhoIsHere, HasABound) {
  WhoIsHere here;
  for (int i = 0; i < 3000; ++i) {
    here.heard(std::to_string(i), write_presence({true, 1}));
  }
  EXPECT_EQ(here.count(), 1000U);
}

}  // namespace
}  // namespace telemime
