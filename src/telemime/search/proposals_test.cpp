// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/proposals.h"

#include <gtest/gtest.h>

#include <limits>

#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

TEST(Proposals, FitIntoTheirEvaluations) {
  const ProposalConfig whole;
  EXPECT_EQ(whole.within(whole.evaluations()).directions, whole.directions);
  for (int most = 0; most <= whole.evaluations() + 10; ++most) {
    const ProposalConfig less = whole.within(most);
    if (!less.any_arms()) {
      EXPECT_LT(most, 50) << "room enough for a few";
      continue;
    }
    ASSERT_LE(less.evaluations(), most);
    ASSERT_GE(less.kept, 1);
    ASSERT_LE(less.directions, whole.directions);
  }
}

TEST(Proposals, NoneStayNone) {
  EXPECT_FALSE(no_proposals().any_arms());
  EXPECT_FALSE(no_proposals().within(1000).any_arms());
  EXPECT_FALSE(no_proposals().within(0).any_arms());
}

TEST(Proposals, RefuseValuesByName) {
  EXPECT_NO_THROW(check_settings(ProposalConfig{}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  testing_errors::expect_refused<ProposalConfig>({
      {"proposals.", [](auto& c) { c.directions = -1; }},
      {"proposals.", [](auto& c) { c.arms = -1; }},
      {"proposals.", [](auto& c) { c.kept = -1; }},
      {"proposals.", [](auto& c) { c.turns = -1; }},
      {"proposals.", [](auto& c) { c.refine = -1; }},
      {"kept", [](auto& c) { c.kept = 0; }},
      {"margin", [](auto& c) { c.margin = -0.1; }},
      {"margin", [=](auto& c) { c.margin = nan; }},
  });
  ProposalConfig most;
  most.directions = most.arms = most.turns = most.refine = 10000;
  most.kept = 100;
  EXPECT_NO_THROW(check_settings(most));
  EXPECT_GT(most.evaluations(), 0) << "no overflow";
}

}  // namespace
}  // namespace telemime
