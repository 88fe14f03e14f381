// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/attendance.h"

#include <gtest/gtest.h>

#include "meeting/protocol/messages.h"

namespace telemime::meeting {
namespace {

TEST(Attendance, CountsWhoCameAndDidNotLeave) {
  Attendance here;
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

TEST(Attendance, TheEndOfAnOlderSessionRemovesNobody) {
  Attendance here;
  here.heard("a", write_presence({true, 1}));
  here.heard("a", write_presence({true, 2}));
  here.heard("a", write_presence({false, 1}));
  EXPECT_TRUE(here.has("a"));
  here.heard("a", write_presence({false, 2}));
  EXPECT_FALSE(here.has("a"));
  here.heard("b", write_presence({false, 1}));
  EXPECT_EQ(here.count(), 0U);
}

TEST(Attendance, RubbishChangesNothing) {
  Attendance here;
  here.heard("a", write_presence({true, 1}));
  here.heard("a", "gone!");
  here.heard("b", "{}");
  EXPECT_EQ(here.count(), 1U);
}

TEST(Attendance, HasABound) {
  Attendance here;
  for (int i = 0; i < 3000; ++i) {
    here.heard(std::to_string(i), write_presence({true, 1}));
  }
  EXPECT_EQ(here.count(), 1000U);
}

}  // namespace
}  // namespace telemime::meeting
