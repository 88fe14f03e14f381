// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/sender_state_reporter.h"

#include <gtest/gtest.h>

namespace telemime {
namespace {

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
