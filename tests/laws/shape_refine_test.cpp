// SPDX-License-Identifier: Apache-2.0
// The shape of a person from several frames rendered from the model.
#include "telemime/search/shape_refine.h"

#include <gtest/gtest.h>

#include "support/rendered_person.h"

namespace telemime {
namespace {

using testing_poses::kDegree;

constexpr std::array<Segment, 4> kArmSegments = {Segment::l_upper_arm, Segment::r_upper_arm,
                                                 Segment::l_forearm, Segment::r_forearm};

Shape person(double upper, double fore) {
  Shape shape;
  shape.stature = 1.72;
  for (const Segment s : kArmSegments) {
    shape[s].length = s == Segment::l_upper_arm || s == Segment::r_upper_arm ? upper : fore;
  }
  return shape;
}

// Keyframes of a tracker with the wrong shape: the joints project to the right pixels.
std::vector<Keyframe> keyframes(const Shape& truth, const Shape& believed) {
  const Camera camera = camera_from_field_of_view(160, 120, 60.0);
  const Model model = make_model(truth);
  const Body wrong = make_body(believed);
  std::vector<Pose> poses = support::gestures();
  poses.push_back(support::seated({-40 * kDegree, 20 * kDegree, 50 * kDegree, -70 * kDegree},
                                  {-10 * kDegree, 30 * kDegree, 60 * kDegree, -100 * kDegree}));
  poses.push_back(support::seated({0, 60 * kDegree, 60 * kDegree, -80 * kDegree},
                                  {0, 60 * kDegree, 70 * kDegree, -60 * kDegree}));
  std::vector<Keyframe> frames;
  for (const Pose& pose : poses) {
    Keyframe k;
    k.frame = prepare(support::observe(model, pose, camera), camera);
    k.pose = carry_pose(model.body, wrong, pose, anatomical_limits());
    frames.push_back(k);
  }
  return frames;
}

double worst_length_error(const Shape& found, const Shape& truth) {
  double worst = 0.0;
  for (const Segment s : kArmSegments) {
    worst = std::max(worst, std::abs(found[s].length / truth[s].length - 1.0));
  }
  return worst;
}

TEST(ShapeRefineLaw, FindsUpperArmAndForearmApart) {
  for (const auto& [upper, fore] : {std::pair(1.06, 0.96), std::pair(0.94, 1.04)}) {
    const Shape truth = person(upper, fore);
    Shape believed = person(0.88, 0.88);  // as estimated from one frame with foreshortened arms
    const auto frames = keyframes(truth, believed);
    const ShapeRefinement found =
        refine_shape([] { return make_scalar_backend(); }, frames, believed, anatomical_limits(), {}, {});
    EXPECT_LT(worst_length_error(found.shape, truth), 0.06) << upper << " " << fore;
    EXPECT_LT(found.cost, found.cost_before);
    ASSERT_EQ(found.poses.size(), frames.size());
    for (const Pose& pose : found.poses) {
      EXPECT_TRUE(anatomical_limits().contains(pose, 1e-6));
    }
    EXPECT_EQ(found.shape[Segment::l_forearm].length, found.shape[Segment::r_forearm].length);
  }
}

TEST(ShapeRefineLaw, SameFramesSameShape) {
  const Shape believed = person(0.9, 0.9);
  const auto frames = keyframes(person(1.0, 1.0), believed);
  ShapeRefineConfig config;
  config.rounds = 1;
  const auto refine = [&] {
    return refine_shape([] { return make_scalar_backend(); }, frames, believed, anatomical_limits(), {},
                        config);
  };
  const ShapeRefinement a = refine();
  const ShapeRefinement b = refine();
  EXPECT_EQ(a.shape[Segment::l_forearm].length, b.shape[Segment::l_forearm].length);
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.evaluations, b.evaluations);
  EXPECT_EQ(a.poses.back().vector(), b.poses.back().vector());
}

TEST(ShapeRefineLaw, WithoutARoundTheShapeStays) {
  const Shape believed = person(0.95, 1.0);
  const auto frames = keyframes(believed, believed);
  ShapeRefineConfig config;
  config.rounds = 0;
  const ShapeRefinement found =
      refine_shape([] { return make_scalar_backend(); }, frames, believed, anatomical_limits(), {}, config);
  EXPECT_EQ(found.shape[Segment::l_upper_arm].length, 0.95);
  EXPECT_EQ(found.cost, found.cost_before);
}

}  // namespace
}  // namespace telemime
