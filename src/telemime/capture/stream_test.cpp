// SPDX-License-Identifier: Apache-2.0
// Tests with real streams are in tests/live.
#include "telemime/capture/stream.h"

#include <gtest/gtest.h>

namespace telemime {
namespace {

// Number of attempts for a stream with this many failures of this duration (s).
struct Tries {
  bool succeed(int failures, double seconds) {
    return grab_past_damage(
        [&, failures, seconds] {
          now += seconds;
          return ++count > failures;
        },
        8.0, {[this] { return now; }, [](double) {}});
  }
  double now = 100.0;
  int count = 0;
};

TEST(GrabPastDamage, SkipsUndecodableImages) {
  Tries tries;
  EXPECT_TRUE(tries.succeed(10, 0.02));
  EXPECT_EQ(tries.count, 11);
}

TEST(GrabPastDamage, OnlyDamagedImagesEndTheStream) {
  Tries tries;
  EXPECT_FALSE(tries.succeed(1000, 0.02));
  EXPECT_EQ(tries.count, 25);
}

TEST(GrabPastDamage, SilentSenderIsWaitedForOnce) {
  Tries tries;
  EXPECT_FALSE(tries.succeed(1000, 8.0));
  EXPECT_EQ(tries.count, 1) << "25 times 8 s are more than three minutes";
}

TEST(GrabPastDamage, AcceptsALateImage) {
  Tries tries;
  EXPECT_TRUE(tries.succeed(0, 7.0));
}

TEST(GrabPastDamage, ATimeOutBringsNoImage) {
  Tries tries;
  EXPECT_FALSE(tries.succeed(0, 8.0)) << "it is an old one that the decoder still held";
}

}  // namespace
}  // namespace telemime
