// SPDX-License-Identifier: Apache-2.0
// Streams themselves are in tests/live.
#include "telemime/capture/stream.h"

#include <gtest/gtest.h>

namespace telemime {
namespace {

// Tries of a stream that fails so often, and takes so long (s) for each failure.
struct Tries {
  bool succeed(int failures, double seconds) {
    return grab_past_damage(
        [&, failures, seconds] {
          now += seconds;
          return ++count > failures;
        },
        {[this] { return now; }, [](double) {}});
  }
  double now = 100.0;
  int count = 0;
};

TEST(GrabPastDamage, SomePicturesThatCannotBeDecodedArePassedOver) {
  Tries tries;
  EXPECT_TRUE(tries.succeed(10, 0.02));
  EXPECT_EQ(tries.count, 11);
}

TEST(GrabPastDamage, NothingButDamageIsTheEnd) {
  Tries tries;
  EXPECT_FALSE(tries.succeed(1000, 0.02));
  EXPECT_EQ(tries.count, 25);
}

TEST(GrabPastDamage, ASilentSenderIsNotWaitedForAgainAndAgain) {
  Tries tries;
  EXPECT_FALSE(tries.succeed(1000, 8.0));
  EXPECT_EQ(tries.count, 1) << "25 times 8 s are more than three minutes";
}

TEST(GrabPastDamage, APictureThatComesLateIsOne) {
  Tries tries;
  EXPECT_TRUE(tries.succeed(0, 8.0));
}

}  // namespace
}  // namespace telemime
