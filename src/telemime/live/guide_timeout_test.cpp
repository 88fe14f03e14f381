// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/guide_timeout.h"

#include <gtest/gtest.h>

namespace telemime {
namespace {

using Step = GuideTimeout::Step;

TEST(GuideTimeout, AsksOnceAndThenSkips) {
  GuideTimeout timeout(60.0);
  EXPECT_EQ(timeout.update(true, 0, 100.0), Step::none);
  EXPECT_EQ(timeout.update(true, 0, 102.5), Step::none) << "a browser needs a moment";
  EXPECT_EQ(timeout.update(true, 0, 103.0), Step::ask);
  EXPECT_EQ(timeout.update(true, 0, 159.9), Step::none);
  EXPECT_EQ(timeout.update(true, 0, 160.0), Step::skip);
}

TEST(GuideTimeout, PageOrOtherPhaseRestartsIt) {
  GuideTimeout timeout(60.0);
  timeout.update(true, 0, 0.0);
  EXPECT_EQ(timeout.update(true, 1, 59.0), Step::none);
  EXPECT_EQ(timeout.update(true, 2, 1000.0), Step::none) << "as long as a page is open";
  EXPECT_EQ(timeout.update(true, 0, 1001.0), Step::none) << "it was closed";
  EXPECT_EQ(timeout.update(true, 0, 1004.0), Step::ask);
  EXPECT_EQ(timeout.update(false, 0, 1005.0), Step::none) << "tracking";
  EXPECT_EQ(timeout.update(true, 0, 2000.0), Step::none) << "the guide was restarted";
  EXPECT_EQ(timeout.update(true, 0, 2059.0), Step::ask);
  EXPECT_EQ(timeout.update(true, 0, 2060.0), Step::skip);
}

TEST(GuideTimeout, ShortTimeoutStillAsksFirst) {
  GuideTimeout timeout(1.0);
  timeout.update(true, 0, 0.0);
  EXPECT_EQ(timeout.update(true, 0, 0.5), Step::ask);
  EXPECT_EQ(timeout.update(true, 0, 1.0), Step::skip);
}

}  // namespace
}  // namespace telemime
