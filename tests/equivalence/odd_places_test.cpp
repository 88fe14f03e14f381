// SPDX-License-Identifier: Apache-2.0
// People in unusual positions: beside the image, behind the camera, very near and far away; and of zero size.
#include "equivalence/every_backend.h"

namespace telemime::equivalence {
namespace {

class OddPlaces : public EveryBackend {
 protected:
  // Poses with their roots in the box, in an image with a person in the middle.
  Deviations at(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Camera& camera,
                int size = 100) {
    Random random(1);
    std::vector<Pose> poses;
    for (int i = 0; i < size; ++i) {
      Pose pose = random_pose(anatomical_limits(), random);
      pose.root = {random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y()),
                   random.uniform(low.z(), high.z())};
      poses.push_back(pose);
    }
    return compared(frame_of(model_, support::gestures().front(), camera), model_, poses);
  }

  const Model model_ = make_model(Shape{});
  const Camera camera_ = camera_of(160, 120);
};
INSTANTIATE_TEST_SUITE_P(Backends, OddPlaces, ::testing::ValuesIn(kBackends), name_of);

TEST_P(OddPlaces, PartlyOutsideOnEachSide) {
  // At 1.2 m the image is 1.4 m wide and 1.0 m high.
  const std::pair<std::string, Eigen::Vector3d> sides[] = {{"left", {-0.7, 0.3, 1.2}},
                                                           {"right", {0.7, 0.3, 1.2}},
                                                           {"above", {0.0, -0.4, 1.2}},
                                                           {"below", {0.0, 1.0, 1.2}}};
  for (const auto& [name, root] : sides) {
    const Eigen::Vector3d around(0.1, 0.1, 0.1);
    expect_within(name, at(root - around, root + around, camera_), {0.00004, 0.06, 0.0005, 0.6, 15, 15});
  }
}

TEST_P(OddPlaces, WhollyOutsideOrBehindTheCamera) {
  const Eigen::Vector3d places[] = {{-5.0, 0.3, 1.2},  {5.0, 0.3, 1.2},  {0.0, -5.0, 1.2}, {0.0, 6.0, 1.2},
                                    {30.0, 30.0, 1.2}, {0.0, 0.3, -2.0}, {0.0, 0.0, -1e3}, {1e4, 0.0, 1.2}};
  const PreparedFrame frame = frame_of(model_, support::gestures().front(), camera_);
  Random random(2);
  for (const Eigen::Vector3d& root : places) {  // the first ones are the first evaluations of this back end
    Pose pose = random_pose(anatomical_limits(), random);
    pose.root = root;
    const Score score = scores_of(*backend_, frame, model_, {&pose, 1}).front();
    EXPECT_EQ(score.region(), 1.0);
    EXPECT_EQ(score.contour(), frame.distance_cap);
    EXPECT_EQ(score.reductions.contour_points, 0);
    EXPECT_EQ(score.reductions.contour_sum, 0.0);
    EXPECT_EQ(score.reductions.model, (std::array<std::int32_t, kSurfaceClassCount>{}));
    EXPECT_EQ(score.reductions.both, (std::array<std::int32_t, kSurfaceClassCount>{}));
  }
}

TEST_P(OddPlaces, HalfBehindTheCamera) {
  expect_within("half_behind", at({-0.3, 0.0, 0.05}, {0.3, 0.5, 0.3}, camera_, 300),
                {0.00003, 0.03, 0.003, 0.6, 60, 27});
}

TEST_P(OddPlaces, SoNearThatEdgesAreLongerThanTheImage) {
  const Camera tele = camera_from_field_of_view(160, 120, 8.0);
  // Where two segments intersect a pixel is less than half a millimetre: the border may move by one pixel.
  expect_within("tele", at({-0.1, -0.1, 0.4}, {0.1, 0.4, 0.7}, tele, 200),
                {0.0001, 0.01, 0.008, 0.5, 400, 90});
  expect_within("tiny", at({-0.1, -0.1, 0.3}, {0.1, 0.4, 0.5}, camera_of(7, 5), 200),
                {0.00006, 0.004, 0.012, 0.6, 3, 3});
}

TEST_P(OddPlaces, FarAway) {
  expect_within("far", at({-2, -2, 19}, {2, 2, 21}, camera_, 300), {0.00003, 0.015, 0.001, 0.35, 5, 40});
}

// Scales everything, all widths or all lengths of a person by this factor.
std::vector<std::pair<std::string, Shape>> shrunk(double scale) {
  std::vector<std::pair<std::string, Shape>> shapes = {{"point", {}}, {"flat", {}}, {"disc", {}}};
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    shapes[0].second.segments[s] = {scale, scale, scale};
    shapes[1].second.segments[s].width = scale;
    shapes[2].second.segments[s].length = scale;
  }
  return shapes;
}

TEST_P(OddPlaces, OfNoSize) {
  struct Case {
    double scale;
    Tolerance tolerance;
  };
  // When a size is as small as the rounding error of positions, the facing of a triangle is arbitrary.
  const Tolerance rounding = {0.00005, 0.45, 0.0012, 2.0, 3, 300};
  const Case cases[] = {{0.1, {0.00006, 0.02, 0.0012, 0.25, 6, 24}},
                        {1e-3, {0.00003, 0.015, 0.0005, 0.15, 5, 18}},
                        {1e-6, rounding},
                        {0.0, rounding}};
  Random random(4);
  std::vector<Pose> poses;
  poses.reserve(50);
  for (int i = 0; i < 50; ++i) {
    poses.push_back(random_pose(anatomical_limits(), random));
  }
  for (const auto& [width, height] : {std::pair(160, 120), std::pair(161, 121)}) {
    const PreparedFrame frame = frame_of(model_, support::gestures().front(), camera_of(width, height));
    for (const auto& [scale, tolerance] : cases) {
      for (const auto& [name, shape] : shrunk(scale)) {
        expect_within(name + "_" + std::to_string(scale) + "_" + std::to_string(width),
                      compared(frame, make_model(shape), poses), tolerance);
      }
    }
  }
}

// The root is exactly at the centre of a pixel, where everything that is small enough is visible.
TEST_P(OddPlaces, AsSmallAsAPointCoversNoMoreThanPoints) {
  const PreparedFrame frame = frame_of(model_, support::gestures().front(), camera_of(161, 121));
  Pose pose;
  pose.root = {0.0, 0.0, 1.2};
  for (const double scale : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 0.0}) {
    const Model point = make_model(shrunk(scale).front().second);
    const Reductions r = scores_of(*backend_, frame, point, {&pose, 1}).front().reductions;
    EXPECT_LE(r.model[0] + r.model[1] + r.model[2], static_cast<int>(kSegmentCount)) << "scale " << scale;
  }
}

}  // namespace
}  // namespace telemime::equivalence
