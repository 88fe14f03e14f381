// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/evaluate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"
#include "telemime/evaluation/report.h"
#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

std::size_t index(Joint joint) {
  return static_cast<std::size_t>(joint);
}

/// A gesture, and the truth that it is exactly right for.
struct Scene {
  StreamHeader header = testing_motion::header();
  std::vector<MotionFrame> frames = testing_motion::gesture(header, 100);
  Truth truth;

  Scene() {
    truth.name = "scene";
    truth.camera = header.camera;
    for (const MotionFrame& frame : frames) {
      truth.frames.push_back(as_truth(frame.joints));
    }
    truth.last_scored = truth.frames.size() - 1;
  }
  Evaluation run() const { return evaluate(frames, header.camera, truth, {}); }

  /// Moves every joint of every frame and projects it again.
  template <class Change>
  void move_joints(const Change& change) {
    for (MotionFrame& frame : frames) {
      for (std::size_t j = 0; j < kJointCount; ++j) {
        frame.joints.at[j] = change(frame.joints.at[j], j);
        frame.pixels[j] = header.camera.project(frame.joints.at[j]);
      }
    }
  }
};

TEST(Evaluate, TruthAgainstItselfHasNoError) {
  const Evaluation result = Scene().run();
  EXPECT_EQ(result.tracked.frames, 100U);
  EXPECT_NEAR(*result.tracked.scored.camera, 0.0, 1e-12);
  EXPECT_NEAR(*result.tracked.scored.aligned, 0.0, 1e-12);
  EXPECT_NEAR(*result.tracked.scored.fitted, 0.0, 1e-12);
  EXPECT_NEAR(*result.tracked.scored.pixels, 0.0, 1e-9);
  EXPECT_EQ(result.lost, 0.0);
  EXPECT_TRUE(result.swapped.empty());
  EXPECT_EQ(result.mistracked, 0U);
  EXPECT_NEAR(*result.jitter, *result.truth_jitter, 1e-12);
  ASSERT_TRUE(result.lag);
  EXPECT_NEAR(result.lag->frames, 0.0, 0.02);
  EXPECT_NEAR(result.lag->correlation, 1.0, 1e-9);
  EXPECT_FALSE(result.fitted_scale);
  EXPECT_FALSE(result.lost_empty);
}

TEST(Evaluate, AShiftShowsInTheCameraFrameOnly) {
  Scene scene;
  scene.move_joints([](const Eigen::Vector3d& p, std::size_t) {
    return Eigen::Vector3d(p + Eigen::Vector3d(0.0, 0.03, 0.04));
  });
  const Evaluation result = scene.run();
  EXPECT_NEAR(*result.tracked.scored.camera, 0.05, 1e-9);
  EXPECT_NEAR(*result.tracked.scored.aligned, 0.0, 1e-9);
  EXPECT_NEAR(*result.tracked.scored.fitted, 0.0, 1e-9);
  EXPECT_GT(*result.tracked.scored.pixels, 1.0);
}

TEST(Evaluate, SplitsTheAlignedErrorInPlaneAndDepth) {
  Scene scene;
  scene.move_joints([](const Eigen::Vector3d& p, std::size_t j) {
    const bool wrist = j == index(Joint::l_wrist) || j == index(Joint::r_wrist);
    return wrist ? Eigen::Vector3d(p + Eigen::Vector3d(0.03, 0.0, 0.04)) : p;
  });
  const Evaluation result = scene.run();
  const MeanErrors& wrist = result.tracked.by_joint[index(Joint::l_wrist)];
  EXPECT_NEAR(*wrist.aligned, 0.05, 1e-9);
  EXPECT_NEAR(*wrist.image_plane, 0.03, 1e-9);
  EXPECT_NEAR(*wrist.depth, 0.04, 1e-9);
  EXPECT_NEAR(*result.tracked.scored.aligned, 0.025, 1e-9);  // two of the four joints
  EXPECT_NEAR(*result.tracked.aligned_p95, 0.025, 1e-9);
}

TEST(Evaluate, ASimilarityIsFittedAway) {
  Scene scene;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  scene.move_joints([&](const Eigen::Vector3d& p, std::size_t) {
    return Eigen::Vector3d(1.2 * (turn * (p - Eigen::Vector3d(0, 0, 1.3))) + Eigen::Vector3d(0, 0, 1.5));
  });
  const Evaluation result = scene.run();
  EXPECT_NEAR(*result.tracked.scored.fitted, 0.0, 1e-9);
  EXPECT_GT(*result.tracked.scored.aligned, 0.05);
}

TEST(Evaluate, AnUnknownScaleIsFittedOnce) {
  Scene scene;
  scene.truth.scale_known = false;
  scene.move_joints([](const Eigen::Vector3d& p, std::size_t) { return Eigen::Vector3d(0.8 * p); });
  const Evaluation result = scene.run();
  ASSERT_TRUE(result.fitted_scale);
  EXPECT_NEAR(*result.fitted_scale, 1.25, 1e-9);
  EXPECT_NEAR(*result.tracked.scored.camera, 0.0, 1e-9);
  EXPECT_NEAR(*result.tracked.scored.pixels, 0.0, 1e-9);
  EXPECT_NE(evaluation_table(result).find("1.2500"), std::string::npos);
}

TEST(Evaluate, PixelsOfASmallerInputAreComparedInTheTruthsImage) {
  Scene scene;
  const Camera small = scene.header.camera.scaled_to(160, 120);
  for (MotionFrame& frame : scene.frames) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      frame.pixels[j] = small.project(frame.joints.at[j]) + Eigen::Vector2d(1.0, 0.0);
    }
  }
  const Evaluation result = evaluate(scene.frames, small, scene.truth, {});
  EXPECT_NEAR(*result.tracked.scored.pixels, 4.0, 1e-6);
  EXPECT_NEAR(*result.tracked.scored.pixels_at_depth, 4.0 * 1.3 / scene.header.camera.fx, 0.003);
}

TEST(Evaluate, FramesOfARecordingAreComparedByTime) {
  // A recording that holds two frames of three, numbered on, each up to 12 ms from its time.
  Scene scene;
  std::vector<MotionFrame> kept;
  for (std::size_t t = 0; t < scene.frames.size(); ++t) {
    scene.frames[t].time = static_cast<double>(t) / scene.truth.fps;
    if (t % 3 != 2) {
      kept.push_back(scene.frames[t]);
      kept.back().frame = static_cast<std::int64_t>(kept.size()) - 1;
      kept.back().time += t % 2 == 0 ? 0.012 : -0.012;
    }
  }
  EXPECT_FALSE(has_variable_rate(scene.frames, scene.truth.fps));
  EXPECT_TRUE(has_variable_rate(kept, scene.truth.fps));
  const Evaluation by_number = evaluate(kept, scene.header.camera, scene.truth, {});
  const Evaluation by_time = evaluate(kept, scene.header.camera, scene.truth, {.by_time = true});
  EXPECT_GT(*by_number.tracked.scored.aligned, 0.01);
  EXPECT_NEAR(*by_time.tracked.scored.aligned, 0.0, 1e-9);
  EXPECT_EQ(by_time.pose_frames, kept.size());
  EXPECT_EQ(by_time.lag->frames, 0.0);
}

TEST(Evaluate, TheNearestOfFramesAtOneTimeCounts) {
  std::vector<MotionFrame> frames(3);
  frames[0].time = 0.030;
  frames[1].time = 0.041;
  frames[2].time = 0.055;
  const auto numbered = numbered_by_time(frames, 25.0);
  ASSERT_EQ(numbered.size(), 1U);
  EXPECT_EQ(numbered[0].frame, 1);
  EXPECT_EQ(numbered[0].time, 0.041);
}

TEST(Evaluate, FindsExchangedArms) {
  Scene scene;
  for (const std::size_t t : {10U, 11U, 40U}) {
    auto& frame = scene.frames[t];
    for (const auto& [l, r] :
         {std::pair(Joint::l_elbow, Joint::r_elbow), std::pair(Joint::l_wrist, Joint::r_wrist)}) {
      std::swap(frame.joints[l], frame.joints[r]);
      std::swap(frame.pixels[index(l)], frame.pixels[index(r)]);
    }
  }
  EXPECT_EQ(scene.run().swapped, (std::vector<std::int64_t>{10, 11, 40}));
}

TEST(Evaluate, FindsALagBelowTheFrame) {
  Scene scene;
  for (const double late : {-3.0, 0.0, 2.0, 2.4}) {
    scene.frames = testing_motion::gesture(scene.header, 100, 2.0, late);
    const Evaluation result = scene.run();
    ASSERT_TRUE(result.lag);
    EXPECT_NEAR(result.lag->frames, late, 0.05);
  }
}

TEST(Evaluate, NoLagIsClaimedOfAStillPerson) {
  Scene scene;
  for (std::size_t t = 0; t < scene.frames.size(); ++t) {
    scene.frames[t].joints = scene.frames[0].joints;
    scene.truth.frames[t] = scene.truth.frames[0];
  }
  EXPECT_FALSE(scene.run().lag);
}

TEST(Evaluate, MeasuresJitter) {
  Scene scene;
  const JointPositions still = scene.frames[0].joints;
  for (std::size_t t = 0; t < scene.frames.size(); ++t) {
    scene.truth.frames[t] = as_truth(still);
    scene.frames[t].joints = still;
    const Eigen::Vector3d step(t % 2 == 0 ? 0.001 : -0.001, 0.0, 0.0);
    scene.frames[t].joints[Joint::l_wrist] += step;
    scene.frames[t].joints[Joint::r_wrist] += step;
  }
  const Evaluation result = scene.run();
  EXPECT_NEAR(*result.jitter, 0.004, 1e-12);
  EXPECT_NEAR(*result.truth_jitter, 0.0, 1e-12);
}

TEST(Evaluate, CountsLostFramesBothWays) {
  Scene scene;
  for (std::size_t t = 50; t < 60; ++t) {  // lost, still holding the pose of frame 49
    scene.frames[t].state = TrackState::lost;
    scene.frames[t].joints = scene.frames[49].joints;
    scene.frames[t].pixels = scene.frames[49].pixels;
  }
  const Evaluation result = scene.run();
  EXPECT_NEAR(result.lost, 0.10, 1e-12);
  EXPECT_NEAR(result.lost_scored, 0.10, 1e-12);
  EXPECT_EQ(result.tracked.frames, 90U);
  EXPECT_EQ(result.all.frames, 100U);
  EXPECT_NEAR(*result.tracked.scored.aligned, 0.0, 1e-12);
  EXPECT_GT(*result.all.scored.aligned, 0.001);
}

TEST(Evaluate, FramesMissingFromTheFileAreLost) {
  Scene scene;
  scene.frames.erase(scene.frames.begin() + 20, scene.frames.begin() + 30);
  scene.frames.erase(scene.frames.begin(), scene.frames.begin() + 2);
  for (std::size_t t = 0; t < 3; ++t) {
    scene.frames[t].state = TrackState::lost;  // before the first pose
  }
  scene.frames.push_back(scene.frames.back());
  scene.frames.back().frame = 100;  // the truth ends with 99
  const Evaluation result = scene.run();
  EXPECT_NEAR(result.lost, 0.15, 1e-12);
  EXPECT_EQ(result.tracked.frames, 85U);
  EXPECT_EQ(result.all.frames, 95U);
  EXPECT_EQ(result.unmeasured_frames, 5U);
  EXPECT_EQ(result.extra_pose_frames, 1U);
}

TEST(Evaluate, OnlyVisibleFramesAreScored) {
  Scene scene;
  scene.truth.visible.assign(100, true);
  for (std::size_t t = 0; t < 40; ++t) {
    scene.truth.visible[t] = false;
    if (t < 30) {
      scene.frames[t].state = TrackState::lost;
    }
  }
  const Evaluation result = scene.run();
  EXPECT_EQ(result.scored_frames, 60U);
  EXPECT_EQ(result.lost_scored, 0.0);
  EXPECT_NEAR(result.lost, 0.3, 1e-12);
  ASSERT_TRUE(result.lost_empty);
  EXPECT_NEAR(*result.lost_empty, 0.75, 1e-12);
}

TEST(Evaluate, CountsPeaksOfTheScores) {
  Scene scene;
  scene.frames[3].region_score = 0.9;
  scene.frames[4].contour_score = 9.0;
  scene.frames[5].region_score = 0.9;
  scene.frames[5].contour_score = 9.0;
  const Evaluation result = scene.run();
  EXPECT_EQ(result.mistracked, 3U);
  EXPECT_NEAR(*result.mean_region, (98 * 0.25 + 2 * 0.9) / 100, 1e-12);
}

TEST(Evaluate, JointsUnknownToTheTruthAreLeftOut) {
  Scene scene;
  for (auto& joints : scene.truth.frames) {
    joints[index(Joint::head)] = std::nullopt;
    joints[index(Joint::l_wrist)] = std::nullopt;
  }
  scene.truth.frames[7].fill(std::nullopt);
  const Evaluation result = scene.run();
  EXPECT_NEAR(*result.tracked.scored.aligned, 0.0, 1e-12);
  EXPECT_FALSE(result.tracked.by_joint[index(Joint::head)].camera);
  EXPECT_TRUE(result.swapped.empty());
  EXPECT_FALSE(result.truth_bones[3]);
  EXPECT_TRUE(
      evaluation_json(result).at("error").at("tracked").at("joints").at("head").at("aligned_mm").is_null());
}

TEST(Evaluate, RefusesPosesOfAnotherClip) {
  Scene scene;
  for (MotionFrame& frame : scene.frames) {
    frame.frame += 1000;
  }
  EXPECT_THROW(scene.run(), Error);
}

// Every joint's standard deviations across and along the view, m.
PoseSpread spread_of(double across, double depth) {
  PoseSpread spread;
  spread.covariance.fill(Eigen::Vector3d(across * across, across * across, depth * depth).asDiagonal());
  return spread;
}

TEST(Evaluate, NothingIsCoveredWhereNoSpreadIsStated) {
  const Evaluation result = Scene().run();
  EXPECT_FALSE(result.covered);
  EXPECT_FALSE(result.stated_across);
  EXPECT_FALSE(result.stated_depth);
  for (const auto& covered : result.covered_by_joint) {
    EXPECT_FALSE(covered);
  }
  EXPECT_EQ(evaluation_table(result).find("95 % region"), std::string::npos);
}

TEST(Evaluate, CountsHowOftenTheTruthIsInsideTheStatedRegion) {
  // 0.04 and 0.02 of deviations of 0.02 and 0.01 m: 2 + 2 squared, 8 > 7.8147; a hundredth less is inside.
  for (const auto& [share, inside] : {std::pair{1.0, 0.0}, std::pair{0.98, 1.0}}) {
    Scene scene;
    scene.move_joints([&, at = share](const Eigen::Vector3d& p, std::size_t j) {
      return j == index(Joint::l_wrist) ? Eigen::Vector3d(p + at * Eigen::Vector3d(0.02, 0.0, 0.04)) : p;
    });
    for (MotionFrame& frame : scene.frames) {
      frame.spread = spread_of(0.01, 0.02);
    }
    const Evaluation result = scene.run();
    ASSERT_TRUE(result.covered_by_joint[index(Joint::l_wrist)]);
    EXPECT_EQ(*result.covered_by_joint[index(Joint::l_wrist)], inside);
    EXPECT_EQ(*result.covered_by_joint[index(Joint::r_wrist)], 1.0);
    EXPECT_NEAR(*result.covered, inside > 0.5 ? 1.0 : 0.75, 1e-12) << "one of the four joints";
    EXPECT_NEAR(*result.stated_across, 0.01, 1e-12);
    EXPECT_NEAR(*result.stated_depth, 0.02, 1e-12);
  }
}

TEST(Evaluate, OnlyFramesThatStateASpreadAreCovered) {
  Scene scene;
  scene.move_joints([](const Eigen::Vector3d& p, std::size_t j) {
    return j == index(Joint::r_elbow) ? Eigen::Vector3d(p + Eigen::Vector3d(0.0, 0.05, 0.0)) : p;
  });
  // Four frames tell: one is sure of the wrong, three are not sure at all; one more is lost.
  for (const std::size_t t : {10, 20, 30, 40, 50}) {
    scene.frames[t].spread = t == 10 ? spread_of(0.01, 0.01) : spread_of(0.1, 0.1);
  }
  scene.frames[50].state = TrackState::lost;
  const Evaluation result = scene.run();
  EXPECT_NEAR(*result.covered_by_joint[index(Joint::r_elbow)], 0.75, 1e-12);
  EXPECT_NEAR(*result.covered, 15.0 / 16.0, 1e-12);
  EXPECT_NEAR(*result.stated_across, (0.01 + 3 * 0.1) / 4.0, 1e-12);
  EXPECT_NE(evaluation_table(result).find("95 % region"), std::string::npos);
}

TEST(Evaluate, ASpreadIsAsLargeAsTheSizeThatIsFitted) {
  Scene scene;
  scene.truth.scale_known = false;
  scene.move_joints([](const Eigen::Vector3d& p, std::size_t) { return Eigen::Vector3d(0.5 * p); });
  for (MotionFrame& frame : scene.frames) {
    frame.spread = spread_of(0.01, 0.02);
  }
  const Evaluation result = scene.run();
  EXPECT_NEAR(*result.stated_across, 0.02, 1e-9);
  EXPECT_NEAR(*result.stated_depth, 0.04, 1e-9);
}

TEST(Evaluate, WhoStatesNoDoubtIsNotCovered) {
  Scene scene;
  scene.move_joints([](const Eigen::Vector3d& p, std::size_t j) {
    return j == index(Joint::l_wrist) ? Eigen::Vector3d(p + Eigen::Vector3d(0.05, 0.0, 0.0)) : p;
  });
  for (MotionFrame& frame : scene.frames) {
    frame.spread = spread_of(0.0, 0.0);
  }
  EXPECT_EQ(*scene.run().covered_by_joint[index(Joint::l_wrist)], 0.0);
}

TEST(Evaluate, BoneLengthsOfTheModelAreConstant) {
  const Scene scene;
  const Evaluation result = scene.run();
  for (std::size_t b = 1; b < kBoneNames.size(); ++b) {
    ASSERT_TRUE(result.bones[b]);
    EXPECT_NEAR(result.bones[b]->variation, 0.0, 1e-9);
  }
  EXPECT_NEAR(result.bones[1]->mean, scene.header.body.upper_arm_length[0], 1e-9);
}

TEST(Evaluate, ReportIsWholeForATrackThatWasAlwaysLost) {
  Scene scene;
  for (MotionFrame& frame : scene.frames) {
    frame.state = TrackState::lost;
  }
  const Evaluation result = scene.run();
  EXPECT_EQ(result.tracked.frames, 0U);
  EXPECT_FALSE(result.tracked.scored.aligned);
  EXPECT_FALSE(result.all.scored.aligned);
  EXPECT_EQ(result.unmeasured_frames, 100U);
  EXPECT_NE(evaluation_table(result).find("100.0 %"), std::string::npos);
  EXPECT_EQ(evaluation_json(result).at("lost").at("all_frames"), 1.0);
  EXPECT_TRUE(evaluation_json(result).at("turn").is_null());
}

}  // namespace
}  // namespace telemime
