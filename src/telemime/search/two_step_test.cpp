// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/two_step.h"

#include <gtest/gtest.h>

#include <limits>

#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

TEST(RegistrationConfig, MethodsHaveNames) {
  EXPECT_EQ(parse_method("regions"), Method::regions);
  EXPECT_EQ(parse_method("edges"), Method::edges);
  EXPECT_EQ(parse_method("two-step"), Method::two_step);
  const std::string message = testing_errors::message_of(ErrorKind::usage, [] { parse_method("telepathy"); });
  EXPECT_TRUE(testing_errors::names(message, "telepathy")) << message;
  EXPECT_TRUE(testing_errors::names(message, "two-step")) << "no remedy: " << message;
}

TEST(RegistrationConfig, DefaultsAndReferenceAreValid) {
  EXPECT_NO_THROW(check_settings(RegistrationConfig{}));
  const RegistrationConfig reference = reference_registration();
  EXPECT_NO_THROW(check_settings(reference));
  // One simplex, F alone, then D_C alone, and no term that the thesis does not have.
  EXPECT_FALSE(reference.blocks);
  EXPECT_FALSE(reference.proposals.any_arms());
  EXPECT_EQ(reference.region.cues[cue::kContour], 0.0);
  EXPECT_EQ(reference.edge.cues[cue::kRegion], 0.0);
  for (const ObjectiveWeights& w : {reference.region, reference.edge}) {
    EXPECT_EQ(w.natural, 0.0);
    EXPECT_EQ(w.temporal, 0.0);
  }
}

TEST(Prior, BetweenTwoFramesIsNearerToTheNearerOne) {
  const Body body = make_body(Shape{});
  Pose a, b;
  b.root.x() = 0.4;
  const auto share = [&](double of) {
    return prior_between(body, a, b, of, 0.0).predicted->joints[Joint::l_wrist].x() -
           forward_kinematics(body, a).joints[Joint::l_wrist].x();
  };
  EXPECT_NEAR(share(0.5), 0.2, 1e-12);
  EXPECT_NEAR(share(0.1), 0.04, 1e-12);
}

TEST(RegistrationConfig, RefusesValuesByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  testing_errors::expect_refused<RegistrationConfig>({
      {"iterations", [](auto& c) { c.iterations = 0; }},
      {"iterations", [](auto& c) { c.iterations = -5; }},
      {"region_share", [](auto& c) { c.region_share = 1.01; }},
      {"region_share", [=](auto& c) { c.region_share = nan; }},
      {"simplex_factor", [](auto& c) { c.simplex_factor = 0.0; }},
      {"simplex_factor", [=](auto& c) { c.simplex_factor = nan; }},
      {"edge_factor", [](auto& c) { c.edge_factor = -1.0; }},
      {"rounds", [](auto& c) { c.rounds = 0; }},
      {"proposals", [](auto& c) { c.proposals.directions = -1; }},
      {"proposal_share", [=](auto& c) { c.proposal_share = nan; }},
      {"tolerance", [](auto& c) { c.tolerance = -1e-9; }},
      {"region_step.region", [](auto& c) { c.region.cues[cue::kRegion] = -1.0; }},
      {"edge_step.contour", [=](auto& c) { c.edge.cues[cue::kContour] = nan; }},
      {"edge_step.trunk", [](auto& c) { c.edge.trunk = -1.0; }},
  });
}

}  // namespace
}  // namespace telemime
