// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/smoother.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "telemime/body/testing_poses.h"
#include "telemime/core/errors.h"
#include "telemime/core/random.h"
#include "telemime/tracker/joint_rotations.h"
#include "telemime/tracker/testing_smoothing.h"

namespace telemime {
namespace {

using testing::kFps;
using testing::standing;

const std::vector<std::string> kFilters = {"recursive", "one-euro"};

struct Rig : testing::Stage {
  std::vector<MotionFrame> smoothed(const std::string& name, const std::vector<MotionFrame>& frames) const {
    SmoothingOptions options;
    options.name = name;
    const auto smoother = make_smoother(options, body, camera);
    std::vector<MotionFrame> result;
    result.reserve(frames.size());
    for (const MotionFrame& frame : frames) {
      result.push_back((*smoother)(frame));
    }
    return result;
  }
};

double largest_move(const MotionFrame& a, const MotionFrame& b) {
  return testing_poses::farthest_joint(a.joints, b.joints);
}

/// Mean second difference of the right wrist, m/frame^2.
double jitter(const std::vector<MotionFrame>& frames, std::size_t from) {
  double sum = 0.0;
  for (std::size_t t = from + 1; t + 1 < frames.size(); ++t) {
    sum += (frames[t + 1].joints[Joint::r_wrist] - 2.0 * frames[t].joints[Joint::r_wrist] +
            frames[t - 1].joints[Joint::r_wrist])
               .norm();
  }
  return sum / static_cast<double>(frames.size() - 2 - from);
}

Pose noisy(Pose pose, Random& random) {
  for (double& angle : pose.angles) {
    angle += random.normal(0.0, 0.03);
  }
  for (double& coordinate : pose.root) {
    coordinate += random.normal(0.0, 0.005);
  }
  return pose;
}

TEST(JointRotations, AreTheInverseOfEachOther) {
  Random random(1);
  const JointLimits limits = anatomical_limits();
  for (int n = 0; n < 500; ++n) {
    const Pose pose = testing_poses::random_pose(limits, random);
    EXPECT_LT((pose_of(rotations_of(pose), pose).vector() - pose.vector()).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(JointRotations, KeepTheAnglesOfAnArmStraightAhead) {
  Pose pose = standing();
  pose[Angle::l_shoulder_flexion] = -std::numbers::pi / 2.0;
  pose[Angle::l_shoulder_abduct] = 0.7;
  pose[Angle::l_shoulder_twisting] = -0.4;
  const Pose back = pose_of(rotations_of(pose), pose);
  EXPECT_LT((back.vector() - pose.vector()).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(JointRotations, KeepWholeTurns) {
  Pose pose = standing();
  pose[Angle::root_torsion] = 7.0;
  EXPECT_NEAR(pose_of(rotations_of(pose), pose)[Angle::root_torsion], 7.0, 1e-9);
}

TEST(Smoother, NoneChangesNothing) {
  const Rig rig;
  Random random(2);
  const auto frames = rig.frames(5, [&](int) { return noisy(standing(), random); });
  const auto same = rig.smoothed("none", frames);
  for (std::size_t t = 0; t < frames.size(); ++t) {
    EXPECT_EQ(same[t].pose.vector(), frames[t].pose.vector());
  }
}

TEST(Smoother, AStillPoseStaysWhereItIs) {
  const Rig rig;
  Pose pose = standing();
  pose[Angle::r_elbow_flexion] = -1.0;
  pose[Angle::r_wrist_twisting] = 0.5;
  for (const auto& name : kFilters) {
    for (const MotionFrame& frame : rig.smoothed(name, rig.frames(20, [&](int) { return pose; }))) {
      EXPECT_LT((frame.pose.vector() - pose.vector()).cwiseAbs().maxCoeff(), 1e-6);
    }
  }
}

TEST(Smoother, JointsAndPixelsBelongToTheSmoothedPose) {
  const Rig rig;
  Random random(3);
  const auto frames = rig.frames(20, [&](int) { return noisy(standing(), random); });
  for (const auto& name : kFilters) {
    for (const MotionFrame& frame : rig.smoothed(name, frames)) {
      const MotionFrame expected = rig.frame(frame.pose, static_cast<int>(frame.frame));
      EXPECT_LT(largest_move(frame, expected), 1e-12);
      for (std::size_t j = 0; j < kJointCount; ++j) {
        EXPECT_LT((frame.pixels[j] - expected.pixels[j]).norm(), 1e-9);
      }
    }
  }
}

TEST(Smoother, RecursiveIsEquation430ForASingleAngle) {
  const Rig rig;
  const auto frames = rig.frames(10, [](int t) {
    Pose pose = standing();
    pose[Angle::l_shoulder_abduct] = t == 0 ? 0.0 : 1.0;
    pose[Angle::l_elbow_flexion] = t == 0 ? 0.0 : -1.0;
    return pose;
  });
  const auto smooth = rig.smoothed("recursive", frames);
  for (std::size_t t = 0; t < smooth.size(); ++t) {
    const double expected = 1.0 - std::pow(0.6, static_cast<double>(t));
    EXPECT_NEAR(smooth[t].pose[Angle::l_shoulder_abduct], expected, 1e-9);
    EXPECT_NEAR(smooth[t].pose[Angle::l_elbow_flexion], -expected, 1e-9);
  }
}

TEST(Smoother, OneEuroIsStillerAtRestAndSoonerInMotionThanRecursive) {
  const Rig rig;
  Random random(4);
  const auto still = rig.frames(300, [&](int) { return noisy(standing(), random); });
  const double raw = jitter(still, 50);
  const double recursive = jitter(rig.smoothed("recursive", still), 50);
  const double one_euro = jitter(rig.smoothed("one-euro", still), 50);
  EXPECT_LT(recursive, 0.5 * raw);
  EXPECT_LT(one_euro, recursive);

  // A fast swing: 2 rad there and back each second. The delay is how far a steady motion is left behind.
  const auto swing = rig.frames(200, [](int t) {
    Pose pose = standing();
    pose[Angle::r_shoulder_flexion] = -1.0 + std::sin(2.0 * std::numbers::pi * t / kFps);
    return pose;
  });
  const auto error = [&](const std::string& name) {
    const auto smooth = rig.smoothed(name, swing);
    double sum = 0.0;
    for (std::size_t t = 50; t < swing.size(); ++t) {
      sum += std::abs(smooth[t].pose[Angle::r_shoulder_flexion] - swing[t].pose[Angle::r_shoulder_flexion]);
    }
    return sum / static_cast<double>(swing.size() - 50);
  };
  EXPECT_LT(error("one-euro"), error("recursive"));
  EXPECT_LT(error("recursive"), 0.5);
  RecordProperty("jitter_raw_um", static_cast<int>(1e6 * raw));
  RecordProperty("jitter_recursive_um", static_cast<int>(1e6 * recursive));
  RecordProperty("jitter_one_euro_um", static_cast<int>(1e6 * one_euro));
  RecordProperty("swing_error_recursive_mrad", static_cast<int>(1e3 * error("recursive")));
  RecordProperty("swing_error_one_euro_mrad", static_cast<int>(1e3 * error("one-euro")));
}

TEST(Smoother, OnlyAnArmOutsideTheImageIsSteadier) {
  const Rig rig;
  Random random(8);
  const auto seen = rig.frames(200, [&](int) { return noisy(standing(), random); });
  // The right arm is uncertain: outside the image from the elbow on, or with its hand visible. Most of the
  // upper arm is outside, too, unless the shoulder is far inside.
  const auto uncertain = [&](bool hand_visible, double shoulder) {
    auto frames = seen;
    for (MotionFrame& frame : frames) {
      frame.spread = PoseSpread{};
      frame.spread->covariance.fill(1e-4 * Eigen::Matrix3d::Identity());
      for (const Joint joint : {Joint::r_elbow, Joint::r_wrist, Joint::r_hand}) {
        const auto j = static_cast<std::size_t>(joint);
        frame.spread->covariance[j] = 0.05 * Eigen::Matrix3d::Identity();
        frame.pixels[j] = {hand_visible && joint == Joint::r_hand ? 10.0 : -10.0, 10.0};
      }
      frame.pixels[static_cast<std::size_t>(Joint::r_shoulder)] = {shoulder, 10.0};
    }
    return rig.smoothed("one-euro", frames);
  };
  const auto plain = rig.smoothed("one-euro", seen);
  const auto outside = uncertain(false, 5.0);
  const auto with_hand = uncertain(true, 5.0);
  const auto with_upper_arm = uncertain(false, 50.0);
  const auto roughness = [](const std::vector<MotionFrame>& frames, Angle angle) {
    double sum = 0.0;
    for (std::size_t t = 51; t + 1 < frames.size(); ++t) {
      sum += std::abs(frames[t + 1].pose[angle] - 2.0 * frames[t].pose[angle] + frames[t - 1].pose[angle]);
    }
    return sum;
  };
  for (const Angle angle : {Angle::r_elbow_flexion, Angle::r_shoulder_flexion}) {
    EXPECT_LT(roughness(outside, angle), 0.5 * roughness(plain, angle));
    EXPECT_EQ(roughness(with_hand, angle), roughness(plain, angle)) << "it follows the image";
  }
  EXPECT_EQ(roughness(with_upper_arm, Angle::r_shoulder_flexion),
            roughness(plain, Angle::r_shoulder_flexion));
  EXPECT_LT(roughness(with_upper_arm, Angle::r_elbow_flexion),
            0.5 * roughness(plain, Angle::r_elbow_flexion));
  EXPECT_EQ(roughness(outside, Angle::l_elbow_flexion), roughness(plain, Angle::l_elbow_flexion));
}

TEST(Smoother, AStepIsReachedWithoutOvershoot) {
  const Rig rig;
  const auto frames = rig.frames(100, [](int t) {
    Pose pose = standing();
    pose[Angle::l_shoulder_flexion] = t < 10 ? 0.0 : -1.0;
    return pose;
  });
  for (const auto& name : kFilters) {
    const auto smooth = rig.smoothed(name, frames);
    for (std::size_t t = 1; t < smooth.size(); ++t) {
      EXPECT_LE(smooth[t].pose[Angle::l_shoulder_flexion],
                smooth[t - 1].pose[Angle::l_shoulder_flexion] + 1e-9);
      EXPECT_GE(smooth[t].pose[Angle::l_shoulder_flexion], -1.0 - 1e-9);
    }
    EXPECT_NEAR(smooth.back().pose[Angle::l_shoulder_flexion], -1.0, 0.01);
  }
}

TEST(Smoother, ArmsStraightAheadDoNotBlowUp) {
  const Rig rig;
  Random random(5);
  // A hand held straight ahead, its shoulder's rotation disturbed by a degree: abduct and twisting jump by up
  // to half a turn against each other although the arm hardly moves.
  const auto frames = rig.frames(300, [&](int) {
    Pose pose = standing();
    pose[Angle::r_shoulder_flexion] = -std::numbers::pi / 2.0;
    JointRotations rotations = rotations_of(pose);
    const Eigen::Vector3d axis(random.normal(), random.normal(), random.normal());
    rotations.rotation[3] =
        rotations.rotation[3] * Eigen::Quaterniond(Eigen::AngleAxisd(0.017, axis.normalized()));
    return pose_of(rotations, standing());
  });
  double spread = 0.0;
  for (const MotionFrame& frame : frames) {
    spread = std::max(spread, std::abs(frame.pose[Angle::r_shoulder_abduct]));
  }
  EXPECT_GT(spread, 1.0);  // the angles do jump, so the test means something
  const double raw = jitter(frames, 0);
  for (const auto& name : kFilters) {
    const auto smooth = rig.smoothed(name, frames);
    EXPECT_LT(jitter(smooth, 0), 0.6 * raw);
    for (std::size_t t = 0; t < frames.size(); ++t) {
      EXPECT_LT(largest_move(smooth[t], frames[t]), 0.03);
      EXPECT_TRUE(smooth[t].pose.vector().allFinite());
      for (std::size_t a = 0; a < kAngleCount; ++a) {
        EXPECT_LE(std::abs(smooth[t].pose.angles[a] - frames[t].pose.angles[a]), std::numbers::pi + 1e-9);
      }
    }
  }
}

TEST(Smoother, TurningOnIsFollowedAcrossTheSeam) {
  const Rig rig;
  const auto frames = rig.frames(100, [](int t) {
    Pose pose = standing();
    pose[Angle::root_torsion] = std::remainder(0.1 * t, 2.0 * std::numbers::pi);
    return pose;
  });
  for (const auto& name : kFilters) {
    const auto smooth = rig.smoothed(name, frames);
    for (std::size_t t = 0; t < frames.size(); ++t) {
      EXPECT_LT(std::abs(smooth[t].pose[Angle::root_torsion] - frames[t].pose[Angle::root_torsion]), 0.3);
    }
  }
}

TEST(Smoother, ForgetsWhenLostOrAfterAGap) {
  const Rig rig;
  Pose away = standing();
  away[Angle::l_shoulder_flexion] = -1.5;
  for (const auto& name : kFilters) {
    SmoothingOptions options;
    options.name = name;
    const auto smoother = make_smoother(options, rig.body, rig.camera);
    (*smoother)(rig.frame(standing(), 0));
    MotionFrame lost = rig.frame(away, 1);
    lost.state = TrackState::lost;
    EXPECT_EQ((*smoother)(lost).pose.vector(), lost.pose.vector());
    EXPECT_LT(largest_move((*smoother)(rig.frame(away, 2)), rig.frame(away, 2)), 1e-9);
    EXPECT_GT(largest_move((*smoother)(rig.frame(standing(), 3)), rig.frame(standing(), 3)), 0.01);
    EXPECT_LT(largest_move((*smoother)(rig.frame(away, 60)), rig.frame(away, 60)), 1e-9);
    EXPECT_LT(largest_move((*smoother)(rig.frame(standing(), 60)), rig.frame(standing(), 60)), 1e-9);
  }
}

TEST(Smoother, OnePoseThatIsNotFiniteDoesNoHarm) {
  const Rig rig;
  auto frames = rig.frames(6, [](int) { return standing(); });
  frames[2].pose[Angle::neck_tilt] = std::numeric_limits<double>::quiet_NaN();
  for (const auto& name : kFilters) {
    EXPECT_LT(largest_move(rig.smoothed(name, frames).back(), frames.back()), 1e-9);
  }
}

TEST(Smoother, RefusesWhatCannotWork) {
  const Rig rig;
  const auto refused = [&](const std::function<void(SmoothingOptions&)>& change) {
    SmoothingOptions options;
    change(options);
    EXPECT_THROW(make_smoother(options, rig.body, rig.camera), Error);
  };
  refused([](SmoothingOptions& o) { o.name = "kalman"; });
  refused([](SmoothingOptions& o) { o.angles.minimum_cutoff = 0.0; });
  refused([](SmoothingOptions& o) { o.root.slope = -1.0; });
  refused([](SmoothingOptions& o) { o.root.speed_cutoff = std::numeric_limits<double>::quiet_NaN(); });
  refused([](SmoothingOptions& o) {
    o.name = "recursive";
    o.recursive_coefficient = 1.0;
  });
}

}  // namespace
}  // namespace telemime
