// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/simd/simd_backend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "telemime/body/testing_poses.h"
#include "telemime/core/testing_errors.h"
#include "telemime/render/renderer.h"

namespace telemime {
namespace {

using testing_poses::random_pose;

constexpr std::array<std::string_view, 3> kFused = {"avx512", "avx2", "neon"};

// The model in its default pose as labels, and a distance map with no two neighbours alike.
PreparedFrame make_frame(const Model& model, int width, int height) {
  const Camera camera = camera_from_field_of_view(width, height, 60.0);
  Pose pose;
  pose.root = {0.0, 0.35, 1.4};
  Rendering rendering;
  render(model.mesh, forward_kinematics(model.body, pose), camera, rendering);
  FrameFeatures seen;
  seen.labels = cv::Mat(height, width, CV_8UC1, rendering.surface.data()).clone();
  seen.labels.col(width / 3).setTo(255);
  seen.distance = cv::Mat(height, width, CV_32FC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      seen.distance.at<float>(y, x) =
          static_cast<float>(10.0 + 9.0 * std::sin(0.37 * x) * std::cos(0.23 * y));
    }
  }
  return prepare(seen, camera);
}

// Poses in front of the camera; some are partly or entirely outside the image or behind the camera.
std::vector<Pose> random_poses(std::size_t size, std::uint64_t seed) {
  Random random(seed);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < size; ++i) {
    poses.push_back(random_pose(anatomical_limits(), random));
    if (i % 7 == 3) {
      poses.back().root = {random.uniform(-2, 2), random.uniform(-1, 1), random.uniform(-0.5, 1.0)};
    }
  }
  return poses;
}

std::vector<Score> scores_of(Backend& backend, const PreparedFrame& frame, const Model& model,
                             std::span<const Pose> poses, Reduction terms = Reduction::all) {
  std::vector<Score> scores(poses.size());
  backend.evaluate(frame, model, poses, terms, scores);
  return scores;
}

bool same_bits(const Score& a, const Score& b) {
  return a.costs == b.costs && a.reductions.observed == b.reductions.observed &&
         a.reductions.model == b.reductions.model && a.reductions.both == b.reductions.both &&
         a.reductions.contour_sum == b.reductions.contour_sum &&
         a.reductions.contour_points == b.reductions.contour_points;
}

void expect_same(const std::vector<Score>& a, const std::vector<Score>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_TRUE(same_bits(a[i], b[i])) << "pose " << i << ": " << a[i].region() << " " << b[i].region()
                                       << ", " << a[i].contour() << " " << b[i].contour();
  }
}

class Simd : public ::testing::Test {
 protected:
  const Model model_ = make_model(Shape{});
  const PreparedFrame frame_ = make_frame(model_, 160, 120);
  const std::unique_ptr<Backend> backend_ = make_simd_backend();
};

TEST_F(Simd, InstructionSetsOfOneKindGiveTheSameBits) {
  const std::vector<Pose> poses = random_poses(150, 1);
  std::vector<Score> fused;
  std::vector<Score> plain;
  for (const std::string& name : simd_instruction_sets()) {
    SCOPED_TRACE(name);
    const auto backend = make_simd_backend({1, name, SimdStage::count});
    const bool fuses = std::find(kFused.begin(), kFused.end(), name) != kFused.end();
    std::vector<Score>& first = fuses ? fused : plain;
    const std::vector<Score> scores = scores_of(*backend, frame_, model_, poses);
    if (first.empty()) {
      first = scores;
    }
    expect_same(scores, first);
  }
  for (std::size_t i = 0; i < fused.size() && i < plain.size(); ++i) {
    EXPECT_NEAR(fused[i].region(), plain[i].region(), 0.005) << i;
    EXPECT_NEAR(fused[i].contour(), plain[i].contour(), 0.1) << i;
  }
  std::string all;
  for (const std::string& name : simd_instruction_sets()) {
    all += name + " ";
  }
  RecordProperty("instruction_sets", all);
}

TEST_F(Simd, PortableOneIsAlwaysThere) {
  const std::vector<std::string> names = simd_instruction_sets();
  EXPECT_EQ(std::count(names.begin(), names.end(), "portable"), 1);
}

TEST_F(Simd, BatchesOfAnySizeEqualOneByOne) {
  const std::vector<Pose> poses = random_poses(1000, 2);
  std::vector<Score> alone(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    backend_->evaluate(frame_, model_, {&poses[i], 1}, Reduction::all, {&alone[i], 1});
  }
  for (const std::size_t size : {0U, 1U, 3U, 4U, 5U, 7U, 8U, 9U, 15U, 16U, 17U, 1000U}) {
    const std::span<const Pose> some(poses.data(), size);
    expect_same(scores_of(*backend_, frame_, model_, some),
                {alone.begin(), alone.begin() + static_cast<std::ptrdiff_t>(size)});
  }
  // Instruction sets differ in the length of their vectors.
  for (const std::string& name : simd_instruction_sets()) {
    SCOPED_TRACE(name);
    const auto backend = make_simd_backend({1, name, SimdStage::count});
    const std::span<const Pose> some(poses.data(), 17);
    const std::vector<Score> together = scores_of(*backend, frame_, model_, some);
    for (std::size_t i = 0; i < some.size(); ++i) {
      expect_same({together[i]}, scores_of(*backend, frame_, model_, some.subspan(i, 1)));
    }
  }
}

TEST_F(Simd, ScoresDoNotDependOnThreads) {
  const std::vector<Pose> poses = random_poses(1000, 3);
  const std::vector<Score> one = scores_of(*backend_, frame_, model_, poses);
  for (const int threads : {7, 3, 2, 1, 0}) {
    SCOPED_TRACE(threads);
    const auto backend = make_simd_backend({threads, {}, SimdStage::count});
    expect_same(scores_of(*backend, frame_, model_, poses), one);
    expect_same(scores_of(*backend, frame_, model_, poses), one);
    const std::span<const Pose> few(poses.data(), 70);
    expect_same(scores_of(*backend, frame_, model_, few), {one.begin(), one.begin() + 70});
  }
}

std::vector<Kinematics> kinematics_of(const Body& body, std::span<const Pose> poses) {
  std::vector<Kinematics> all;
  for (const Pose& pose : poses) {
    all.push_back(forward_kinematics(body, pose));
  }
  return all;
}

TEST_F(Simd, KinematicsOfTheCallerChangeNothing) {
  const std::vector<Pose> poses = random_poses(200, 13);
  const std::vector<Kinematics> kinematics = kinematics_of(model_.body, poses);
  for (const auto& backend :
       {make_simd_backend(), make_simd_backend({3, {}, SimdStage::count}), make_scalar_backend()}) {
    std::vector<Score> scores(poses.size());
    backend->evaluate(frame_, model_, poses, Reduction::all, scores, kinematics);
    expect_same(scores, scores_of(*backend, frame_, model_, poses));
  }
}

TEST_F(Simd, RefusesAnotherNumberOfKinematics) {
  const std::vector<Pose> poses = random_poses(3, 14);
  const std::vector<Kinematics> kinematics = kinematics_of(model_.body, poses);
  std::vector<Score> scores(poses.size());
  for (const std::size_t size : {1U, 2U}) {
    EXPECT_THROW(
        backend_->evaluate(frame_, model_, poses, Reduction::all, scores, std::span(kinematics).first(size)),
        Error);
  }
}

TEST_F(Simd, TermsThatAreNotAskedForKeepTheirDefaults) {
  const std::vector<Pose> poses = random_poses(40, 4);
  const std::vector<Score> all = scores_of(*backend_, frame_, model_, poses);
  const std::vector<Score> region = scores_of(*backend_, frame_, model_, poses, Reduction::overlap);
  const std::vector<Score> contour = scores_of(*backend_, frame_, model_, poses, Reduction::contour);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Score only_region = all[i];
    only_region.costs[cue::kContour] = Score{}.contour();
    only_region.reductions.contour_sum = 0.0;
    only_region.reductions.contour_points = 0;
    EXPECT_TRUE(same_bits(region[i], only_region)) << i;
    Score only_contour;
    only_contour.costs[cue::kContour] = all[i].contour();
    only_contour.reductions.contour_sum = all[i].reductions.contour_sum;
    only_contour.reductions.contour_points = all[i].reductions.contour_points;
    EXPECT_TRUE(same_bits(contour[i], only_contour)) << i;
  }
}

TEST_F(Simd, OldScoresAreOverwritten) {
  const std::vector<Pose> poses = random_poses(5, 5);
  std::vector<Score> scores(poses.size());
  for (Score& score : scores) {
    score = {{7.0, 7.0}, {{7, 7, 7}, {7, 7, 7}, {7, 7, 7}, 7.0, 7}};
  }
  backend_->evaluate(frame_, model_, poses, Reduction::all, scores);
  expect_same(scores, scores_of(*backend_, frame_, model_, poses));
}

// A new back end.
Score alone(const PreparedFrame& frame, const Model& model, const Pose& pose, Reduction terms) {
  return scores_of(*make_simd_backend(), frame, model, {&pose, 1}, terms).front();
}

TEST_F(Simd, EvaluationsLeaveNoTrace) {
  const Model other = make_model(testing_poses::other_shape());
  const PreparedFrame frames[] = {frame_, make_frame(model_, 320, 240), make_frame(other, 33, 47),
                                  make_frame(other, 120, 160)};
  const std::vector<Pose> poses = random_poses(60, 6);
  Random random(7);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const PreparedFrame& frame = frames[random.below(4)];
    const Model& model = random.below(2) == 0 ? model_ : other;
    const auto terms = static_cast<Reduction>(1 + random.below(3));
    ASSERT_TRUE(same_bits(scores_of(*backend_, frame, model, {&poses[i], 1}, terms).front(),
                          alone(frame, model, poses[i], terms)))
        << i;
  }
}

// A search moves one arm at a time; what does not move is counted once.
TEST_F(Simd, SegmentsThatStayCountAsOthersDo) {
  const Model other = make_model(testing_poses::other_shape());
  PreparedFrame frame = frame_;
  const PreparedFrame frames[] = {frame_, make_frame(other, 160, 120), make_frame(model_, 64, 48),
                                  make_frame(model_, 48, 64)};
  const std::vector<Pose> targets = random_poses(80, 11);
  Random random(12);
  Pose pose = targets.front();
  for (const std::string& name : simd_instruction_sets()) {
    const auto backend = make_simd_backend({1, name, SimdStage::count});
    for (const Pose& target : targets) {
      const std::size_t part = random.below(6);  // trunk, an arm, or none of them
      for (std::size_t i = 0; i < kAngleCount; ++i) {
        const auto a = static_cast<Angle>(i);
        const bool left = kAngleNames[i].starts_with("l_");
        const bool right = kAngleNames[i].starts_with("r_");
        if (part == 0 || (left && part < 3) || (right && (part == 3 || part == 4))) {
          pose[a] = target[a];
        }
      }
      pose.root = part == 0 ? target.root : pose.root;
      if (random.below(10) == 0) {
        frame = frames[random.below(4)];
      }
      const Model& model = random.below(20) == 0 ? other : model_;
      const auto terms = static_cast<Reduction>(1 + random.below(3));
      const auto fresh = make_simd_backend({1, name, SimdStage::count});
      expect_same(scores_of(*backend, frame, model, {&pose, 1}, terms),
                  scores_of(*fresh, frame, model, {&pose, 1}, terms));
    }
  }
}

// The memory for contour points grows while those of segments that stay are kept in it.
TEST_F(Simd, PointsThatStayAreKeptWhereMemoryGrows) {
  const PreparedFrame large = make_frame(model_, 2560, 1920);
  const auto backend = make_simd_backend();
  Pose pose;
  pose.root = {0.0, 0.35, 3.0};
  for (const double z : {3.0, 0.9, 0.5}) {
    pose.root.z() = z;
    for (const double turn : {-0.2, -0.9, -1.5, -0.4}) {
      pose[Angle::l_shoulder_flexion] = turn;
      expect_same(scores_of(*backend, large, model_, {&pose, 1}),
                  {alone(large, model_, pose, Reduction::all)});
    }
  }
}

TEST_F(Simd, FirstPoseMayHaveNothingToShow) {
  Pose behind;
  behind.root.z() = -3.0;
  Pose beside;
  beside.root.x() = 30.0;
  for (const std::string& name : simd_instruction_sets()) {
    for (const Pose& pose : {behind, beside}) {
      const auto fresh = make_simd_backend({1, name, SimdStage::count});
      const Score score = scores_of(*fresh, frame_, model_, {&pose, 1}).front();
      EXPECT_EQ(score.region(), 1.0);
      EXPECT_EQ(score.contour(), frame_.distance_cap);
      EXPECT_EQ(score.reductions.contour_points, 0);
    }
  }
}

TEST_F(Simd, ModelChangedInPlaceIsSeen) {
  Model model = model_;
  const Pose pose = random_poses(1, 8).front();
  for (const double sleeve : {0.5, 0.0, 1.0, 1.5, 0.5}) {
    Shape shape;
    shape.sleeve = sleeve;
    model = make_model(shape);
    EXPECT_TRUE(same_bits(scores_of(*backend_, frame_, model, {&pose, 1}).front(),
                          alone(frame_, model, pose, Reduction::all)));
  }
}

TEST_F(Simd, FrameIsLeftAlone) {
  const PreparedFrame before = make_frame(model_, 160, 120);
  scores_of(*backend_, frame_, model_, random_poses(20, 9));
  EXPECT_EQ(frame_.tiles.labels, before.tiles.labels);
  EXPECT_EQ(frame_.tiles.distance, before.tiles.distance);
  EXPECT_EQ(cv::norm(frame_.labels, before.labels), 0.0);
  EXPECT_EQ(cv::norm(frame_.distance, before.distance), 0.0);
}

void expect_refused(const SimdOptions& options, const std::string& named) {
  const std::string message =
      testing_errors::message_of(ErrorKind::usage, [&] { make_simd_backend(options); });
  EXPECT_TRUE(testing_errors::names(message, named)) << message;
}

TEST_F(Simd, RefusesWhatIsNotOffered) {
  expect_refused({1, "abacus", SimdStage::count}, "abacus");
  expect_refused({1, "abacus", SimdStage::count}, "portable");
  expect_refused({-1, {}, SimdStage::count}, "-1");
  expect_refused({1025, {}, SimdStage::count}, "1025");
  const std::vector<Pose> poses(3);
  for (const std::size_t size : {0U, 2U, 4U}) {
    std::vector<Score> scores(size);
    EXPECT_THROW(backend_->evaluate(frame_, model_, poses, Reduction::all, scores), Error) << size;
  }
  EXPECT_EQ(backend_->name(), "simd");
  EXPECT_FALSE(backend_->device_times());
}

}  // namespace
}  // namespace telemime
