// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/objective.h"

#include <gtest/gtest.h>

#include <span>

namespace telemime {
namespace {

// Notes what it is asked to count.
class Asked final : public Backend {
 public:
  std::string_view name() const override { return "asked"; }
  void count(const PreparedFrame&, const Model&, std::span<const Pose>, Reduction terms,
             std::span<Reductions>) override {
    last = terms;
  }
  Reduction last = Reduction::none;
};

TEST(Objective, OnlyTrustedCuesAreCounted) {
  const Model model = make_model(Shape{});
  const JointLimits limits = anatomical_limits();
  CueValues regions{};
  regions[cue::kRegion] = 1.0;
  const auto counted = [&](bool has_colours) {
    PreparedFrame frame;
    frame.has_colours = has_colours;
    Asked backend;
    Objective objective(backend, frame, model, limits);
    objective(Pose{}, {.cues = regions});
    return backend.last;
  };
  EXPECT_EQ(counted(true), kCues[cue::kRegion].needs);
  EXPECT_EQ(counted(false), Reduction::none) << "without colours the regions say nothing";
}

TEST(ShareOfMotion, FollowsTheTimeBetweenFrames) {
  EXPECT_DOUBLE_EQ(share_of_motion(0.5, 1.0, 1.0), 0.5);
  EXPECT_DOUBLE_EQ(share_of_motion(0.5, 1.0, 2.0), 0.25);
  EXPECT_DOUBLE_EQ(share_of_motion(0.5, 1.5, 1.0), 0.75);
  EXPECT_DOUBLE_EQ(share_of_motion(0.5, 8.0, 0.2), 1.0) << "frames in pairs: the last motion is noise";
}

}  // namespace
}  // namespace telemime
