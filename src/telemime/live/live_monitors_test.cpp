// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_monitors.h"

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

SenderStatus output(const std::string& url, SenderState state, const std::string& words = "") {
  SenderStatus status;
  status.url = url;
  status.state = state;
  status.words = words;
  return status;
}

std::string update(SenderStateReporter& reporter, const std::vector<SenderStatus>& outputs) {
  std::string all;
  for (const SenderStateReporter::Report& report : reporter.update(outputs)) {
    all += (report.level == MessageLevel::warning ? "! " : "") + report.text + "\n";
  }
  return all;
}

TEST(SenderStateReporter, ReportsAFailureOnceAndItsEnd) {
  SenderStateReporter reporter;
  EXPECT_EQ(update(reporter, {output("vmc://a", SenderState::connecting)}), "");
  EXPECT_EQ(update(reporter, {output("vmc://a", SenderState::failed, "no such computer")}),
            "! vmc://a: no such computer\n");
  EXPECT_EQ(update(reporter, {output("vmc://a", SenderState::connecting)}), "");
  EXPECT_EQ(update(reporter, {output("vmc://a", SenderState::failed, "no such computer")}), "");
  EXPECT_EQ(update(reporter, {output("vmc://a", SenderState::sending)}), "vmc://a: sending again\n");
  EXPECT_EQ(update(reporter, {output("vmc://a", SenderState::sending)}), "");
  EXPECT_EQ(update(reporter, {output("vmc://a", SenderState::failed, "gone")}), "! vmc://a: gone\n");
}

TEST(SenderStateReporter, ForgetsOutputsOffOrRemoved) {
  SenderStateReporter reporter;
  const SenderStatus failed = output("vmc://a", SenderState::failed, "gone");
  EXPECT_EQ(update(reporter, {failed, output("vmc://b", SenderState::sending)}), "! vmc://a: gone\n");
  EXPECT_EQ(update(reporter, {output("vmc://a", SenderState::off), output("vmc://b", SenderState::sending)}),
            "");
  EXPECT_EQ(update(reporter, {failed}), "! vmc://a: gone\n");
  EXPECT_EQ(update(reporter, {}), "");
  EXPECT_EQ(update(reporter, {failed}), "! vmc://a: gone\n");
}

}  // namespace
}  // namespace telemime
