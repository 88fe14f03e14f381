// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/pace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace telemime {
namespace {

// A machine on which a full search takes so long.
double settle(Pace& pace, double full_ms, double interval_ms, int frames = 200) {
  for (int i = 0; i < frames; ++i) {
    pace.searched(pace.effort() * full_ms, interval_ms);
  }
  return pace.effort();
}

TEST(Pace, AFastMachineSearchesInFull) {
  Pace pace;
  EXPECT_EQ(pace.effort(), 1.0);
  EXPECT_EQ(settle(pace, 4.0, 40.0), 1.0);
}

TEST(Pace, ASlowOneTakesAboutAThirdOfTheTimeBetweenFrames) {
  Pace pace;
  EXPECT_NEAR(24.0 * settle(pace, 24.0, 40.0), 12.0, 2.0);
  EXPECT_NEAR(24.0 * settle(pace, 24.0, 66.7), 20.0, 2.0);  // a slower camera leaves more
}

TEST(Pace, TheEffortIsNeverNothing) {
  Pace pace;
  EXPECT_EQ(settle(pace, 5000.0, 10.0), 0.25);
  EXPECT_EQ(settle(pace, 1.0, 40.0), 1.0);  // and comes back
}

TEST(Pace, OneFrameThatWaitedChangesLittle) {
  Pace pace;
  const double before = settle(pace, 20.0, 40.0);
  pace.searched(2000.0, 40.0);
  EXPECT_GT(pace.effort(), 0.7 * before);
  EXPECT_NEAR(settle(pace, 20.0, 40.0), before, 0.06);
}

TEST(Pace, TimesThatSayNothingAreNotLearned) {
  Pace pace;
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    pace.searched(bad, 40.0);
    pace.searched(20.0, bad);
  }
  EXPECT_EQ(pace.effort(), 1.0);
}

TEST(Pace, IsKeptWhereNothingSaysHowMuchToSearch) {
  EXPECT_TRUE(keeps_pace({}));
  EXPECT_TRUE(keeps_pace({{"seed", 3}, {"quality", "fast"}}));
  for (const char* const name : {"particles", "budget", "registration.iterations"}) {
    EXPECT_FALSE(keeps_pace({{name, 100}})) << name;
  }
}

}  // namespace
}  // namespace telemime
