// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/proposals.h"

#include <gtest/gtest.h>

#include <limits>

#include "telemime/core/errors.h"

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
  const auto refused = [](const ProposalConfig& config, const std::string& word) {
    try {
      check_settings(config);
      return false;
    } catch (const Error& error) {
      return error.kind() == ErrorKind::config && std::string(error.what()).find(word) != std::string::npos;
    }
  };
  EXPECT_NO_THROW(check_settings(ProposalConfig{}));
  for (int ProposalConfig::*number :
       {&ProposalConfig::directions, &ProposalConfig::arms, &ProposalConfig::kept, &ProposalConfig::turns,
        &ProposalConfig::refine}) {
    ProposalConfig config;
    config.*number = -1;
    EXPECT_TRUE(refused(config, "proposals."));
  }
  ProposalConfig none_kept;
  none_kept.kept = 0;
  EXPECT_TRUE(refused(none_kept, "kept"));
  ProposalConfig most;
  most.directions = most.arms = most.turns = most.refine = 10000;
  most.kept = 100;
  EXPECT_NO_THROW(check_settings(most));
  EXPECT_GT(most.evaluations(), 0) << "no overflow";
  for (const double margin : {-0.1, std::numeric_limits<double>::quiet_NaN()}) {
    ProposalConfig config;
    config.margin = margin;
    EXPECT_TRUE(refused(config, "margin"));
  }
}

}  // namespace
}  // namespace telemime
