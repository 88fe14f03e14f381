// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "telemime/outputs/all.h"
#include "telemime/outputs/gltf/humanoid.h"
#include "telemime/outputs/gltf/keys.h"
#include "telemime/outputs/gltf/testing_glb.h"
#include "telemime/outputs/humanoid.h"
#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

using testing_glb::Glb;

class GltfMotionTest : public testing::TestWithParam<std::unique_ptr<Encoder> (*)()> {
 protected:
  Glb written(const std::vector<MotionFrame>& frames) const {
    return testing_glb::parse(testing_motion::encode_all(*GetParam()(), header_, frames));
  }
  std::vector<MotionFrame> random_frames(std::size_t count) const {
    Random random(7);
    std::vector<MotionFrame> frames;
    for (std::size_t t = 0; t < count; ++t) {
      frames.push_back(testing_motion::frame_of(header_.body, header_.camera,
                                                testing_motion::random_pose(header_.limits, random),
                                                static_cast<std::int64_t>(t), header_.fps));
    }
    return frames;
  }
  /// How far the file is from this pose at this time: the largest angle of a bone, rad.
  double angle_from(const Glb& glb, double time, const Pose& pose) const {
    const HumanoidMotion motion = humanoid_motion(header_.body, pose, pose.root);
    const auto nodes = testing_glb::play(glb, time);
    double largest = 0.0;
    for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
      const std::size_t node = testing_glb::node_named(glb, std::string(kHumanBoneNames[b]));
      largest = std::max(largest, nodes[node].rotation.angularDistance(motion.rotation[b]));
    }
    return largest;
  }

  const StreamHeader header_ = testing_motion::header();
};

constexpr double kAngle = 1e-4;  // rad

TEST_P(GltfMotionTest, DecodesToTheRotationsOfEveryFrame) {
  const auto frames = random_frames(40);
  const Glb glb = written(frames);
  for (const MotionFrame& frame : frames) {
    EXPECT_LT(angle_from(glb, frame.time, frame.pose), kAngle) << frame.frame;
  }
}

TEST_P(GltfMotionTest, HandsAreWhereTheyWere) {
  const auto frames = random_frames(40);
  const Glb glb = written(frames);
  const Eigen::Vector3d root_at_rest = humanoid_skeleton(header_.body).position[1];  // the spine's joint
  const std::vector<double> mm = glb.json["asset"]["extras"]["root_at_start_mm"];
  const Eigen::Vector3d start = Eigen::Vector3d(mm[0], mm[1], mm[2]) / 1000.0;
  EXPECT_LT((start - frames[0].pose.root).norm(), 1e-4);
  const std::map<std::string, Joint> joints = {
      {"leftHand", Joint::l_wrist},      {"rightHand", Joint::r_wrist}, {"leftLowerArm", Joint::l_elbow},
      {"rightLowerArm", Joint::r_elbow}, {"head", Joint::head},         {"neck", Joint::neck}};
  for (const MotionFrame& frame : frames) {
    const auto nodes = testing_glb::play(glb, frame.time);
    for (const auto& [bone, joint] : joints) {
      const Eigen::Vector3d moved = frame.joints[joint] - start;
      const Eigen::Vector3d expected = root_at_rest + Eigen::Vector3d(moved.x(), -moved.y(), -moved.z());
      const Eigen::Vector3d place = testing_glb::place_of(glb, nodes, testing_glb::node_named(glb, bone));
      EXPECT_LT((place - expected).norm(), 0.010) << bone << " in frame " << frame.frame;
    }
  }
}

TEST_P(GltfMotionTest, RestIsATPoseOnTheGround) {
  const Glb glb = written({});
  const auto nodes = testing_glb::play(glb, 0.0);
  const HumanoidSkeleton skeleton = humanoid_skeleton(header_.body);
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    const std::size_t node = testing_glb::node_named(glb, std::string(kHumanBoneNames[b]));
    EXPECT_LT((testing_glb::place_of(glb, nodes, node) - skeleton.position[b]).norm(), 1e-6) << b;
    EXPECT_FALSE(glb.json["nodes"][node].contains("rotation"));  // the axes of the world
  }
}

TEST_P(GltfMotionTest, OneFrameIsOneKey) {
  const auto frames = random_frames(1);
  const Glb glb = written(frames);
  const auto& sampler = glb.json["animations"][0]["samplers"][0];
  EXPECT_EQ(testing_glb::numbers<float>(glb, sampler["input"]), std::vector<float>{0.0F});
  EXPECT_LT(angle_from(glb, 0.0, frames[0].pose), kAngle);
}

TEST_P(GltfMotionTest, ALostPersonStandsStillUntilTheyAreBack) {
  auto frames = random_frames(12);
  for (const std::size_t lost : {0U, 1U, 5U, 6U, 7U, 11U}) {
    frames[lost].state = TrackState::lost;
  }
  const Glb glb = written(frames);
  EXPECT_LT(angle_from(glb, frames[0].time, frames[2].pose), kAngle);  // nothing is known before
  EXPECT_LT(angle_from(glb, frames[4].time, frames[4].pose), kAngle);
  for (const double time : {frames[5].time, frames[6].time - 0.01, frames[7].time}) {
    EXPECT_LT(angle_from(glb, time, frames[4].pose), kAngle) << time;
  }
  EXPECT_LT(angle_from(glb, frames[8].time, frames[8].pose), kAngle);
  EXPECT_LT(angle_from(glb, frames[11].time, frames[10].pose), kAngle);
  const auto times = testing_glb::numbers<float>(glb, glb.json["animations"][0]["samplers"][0]["input"]);
  EXPECT_EQ(times.size(), 8U);  // six tracked frames, the ends of two gaps
  EXPECT_FLOAT_EQ(times.back(), static_cast<float>(frames[11].time));
}

TEST_P(GltfMotionTest, TimesAreFromTheFirstFrameAndGrow) {
  auto frames = random_frames(5);
  for (MotionFrame& frame : frames) {
    frame.time += 1000.0;
  }
  frames[3].time = frames[1].time;  // a clock that jumped back
  const Glb glb = written(frames);
  const auto& input = glb.json["animations"][0]["samplers"][0]["input"];
  const auto times = testing_glb::numbers<float>(glb, input);
  ASSERT_EQ(times.size(), 4U);
  EXPECT_FLOAT_EQ(times[0], 0.0F);
  EXPECT_FLOAT_EQ(times[3], 0.16F);
  const auto& accessor = glb.json["accessors"][input.get<std::size_t>()];
  EXPECT_EQ(accessor["min"][0].get<float>(), times.front());
  EXPECT_EQ(accessor["max"][0].get<float>(), times.back());
}

TEST_P(GltfMotionTest, IsAValidFileAfterEveryFrameWithHalfOfTheMotionAtLeast) {
  const auto frames = random_frames(150);
  const auto encoder = GetParam()();
  std::string file = encoder->begin(header_);
  int patches = 0;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    file += encoder->frame(frames[t]);
    if (const auto patch = encoder->patch()) {
      file.replace(patch->offset, patch->bytes.size(), patch->bytes);
      ++patches;
    }
    if (t % 10 == 9) {
      const Glb glb = testing_glb::parse(file);
      const auto times = testing_glb::numbers<float>(glb, glb.json["animations"][0]["samplers"][0]["input"]);
      if (t < 31) {
        EXPECT_EQ(times, std::vector<float>{0.0F});  // the rest pose, before the first keys are written
        continue;
      }
      EXPECT_GE(times.size(), (t + 1) / 2);
      EXPECT_LT(angle_from(glb, times.back(), frames[times.size() - 1].pose), kAngle);
    }
  }
  EXPECT_LT(patches, 10) << "the head is written again only where it has changed";
}

TEST_P(GltfMotionTest, KeepsNumbersThatAreNotFiniteOut) {
  auto frames = random_frames(3);
  frames[1].pose[Angle::l_elbow_flexion] = std::numeric_limits<double>::quiet_NaN();
  const Glb glb = written(frames);
  EXPECT_LT(angle_from(glb, frames[1].time, frames[0].pose), kAngle);
  for (const auto& sampler : glb.json["animations"][0]["samplers"]) {
    for (const float value : testing_glb::numbers<float>(glb, sampler["output"])) {
      EXPECT_TRUE(std::isfinite(value));
    }
  }
}

TEST_P(GltfMotionTest, SaysWhatItIs) {
  const Glb glb = written(random_frames(2));
  EXPECT_EQ(glb.json["asset"]["version"], "2.0");
  if (GetParam() == &make_vrma_encoder) {
    EXPECT_FALSE(glb.json.contains("meshes"));
    const auto& vrma = glb.json["extensions"]["VRMC_vrm_animation"];
    EXPECT_EQ(vrma["specVersion"], "1.0");
    for (const auto name : kHumanBoneNames) {
      const auto& bone = vrma["humanoid"]["humanBones"][std::string(name)];
      EXPECT_EQ(bone["node"], testing_glb::node_named(glb, std::string(name)));
    }
    return;
  }
  // What the mannequin's vertices follow exists, and each triangle looks outward.
  const auto& primitive = glb.json["meshes"][0]["primitives"][0];
  const auto positions = testing_glb::numbers<float>(glb, primitive["attributes"]["POSITION"]);
  const auto normals = testing_glb::numbers<float>(glb, primitive["attributes"]["NORMAL"]);
  const auto indices = testing_glb::numbers<std::uint16_t>(glb, primitive["indices"]);
  const auto at = [](const std::vector<float>& values, std::size_t i) {
    return Eigen::Vector3f(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
  };
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const Eigen::Vector3f a = at(positions, indices[i]);
    const Eigen::Vector3f face = (at(positions, indices[i + 1]) - a).cross(at(positions, indices[i + 2]) - a);
    EXPECT_GT(face.dot(at(normals, indices[i]) + at(normals, indices[i + 1]) + at(normals, indices[i + 2])),
              0.0F);
  }
}

TEST_P(GltfMotionTest, VrmAnimationAloneHasTheFace) {
  Random random(8);
  auto frames = random_frames(4);
  frames[2].face = testing_motion::random_face(random);
  const Glb glb = written(frames);
  if (GetParam() == &make_glb_encoder) {
    EXPECT_EQ(glb.json["animations"][0]["channels"].size(), kMovingBoneCount + 1) << "bones and hips";
    return;
  }
  const auto weights = vrm_expressions(*frames[2].face);
  const auto& vrma = glb.json["extensions"]["VRMC_vrm_animation"];
  EXPECT_EQ(vrma["expressions"]["preset"].size(), kAnimatedExpressionCount);
  for (const std::size_t shown : {1U, 2U}) {
    const auto nodes = testing_glb::play(glb, frames[shown].time);
    for (std::size_t i = 0; i < kAnimatedExpressionCount; ++i) {
      const std::size_t node = vrma["expressions"]["preset"][std::string(kVrmExpressionNames[i])]["node"];
      EXPECT_NEAR(nodes[node].translation.x(), shown == 2 ? weights[i] : 0.0, 1e-5) << kVrmExpressionNames[i];
    }
    const Eigen::Vector3d look =
        nodes[vrma["lookAt"]["node"].get<std::size_t>()].rotation * Eigen::Vector3d::UnitZ();
    const Eigen::Vector2d gaze = shown == 2 ? frames[2].face->gaze : Eigen::Vector2d(0.0, 0.0);
    EXPECT_NEAR(std::atan2(look.x(), look.z()), gaze.x(), 1e-5);
    EXPECT_NEAR(std::asin(look.y()), gaze.y(), 1e-5);
  }
}

TEST_P(GltfMotionTest, FingersAreWhereTheMotionFrameHasThem) {
  StreamHeader header = header_;
  header.fingers = true;
  auto frames = random_frames(40);
  Random random(9);
  for (MotionFrame& frame : frames) {
    frame.hands = testing_motion::random_hands(header.body, frame.pose, random);
  }
  const Glb glb = testing_glb::parse(testing_motion::encode_all(*GetParam()(), header, frames));
  for (const MotionFrame& frame : frames) {
    const auto nodes = testing_glb::play(glb, frame.time);
    const auto place = [&](std::string_view name) {
      return testing_glb::place_of(glb, nodes, testing_glb::node_named(glb, std::string(name)));
    };
    for (const Side side : {Side::left, Side::right}) {
      const HandPoints& joints = (*frame.hands)[static_cast<std::size_t>(side)].joints;
      const Eigen::Vector3d wrist = place(side == Side::left ? "leftHand" : "rightHand");
      for (std::size_t b = finger_bone(side, 0, 0); b < finger_bone(side, kFingerCount, 0); ++b) {
        const Eigen::Vector3d off = joints[hand_joint(b / 3 % kFingerCount, b % 3)] - joints[0];
        EXPECT_LT((place(kFingerBoneNames[b]) - wrist - Eigen::Vector3d(off.x(), -off.y(), -off.z())).norm(),
                  1e-4)
            << kFingerBoneNames[b] << " in frame " << frame.frame;
      }
    }
  }
  if (GetParam() == &make_vrma_encoder) {
    const auto& bones = glb.json["extensions"]["VRMC_vrm_animation"]["humanoid"]["humanBones"];
    EXPECT_EQ(bones.size(), kHumanBoneCount + kFingerBoneCount);
    EXPECT_EQ(bones["rightThumbMetacarpal"]["node"], testing_glb::node_named(glb, "rightThumbMetacarpal"));
  } else {
    EXPECT_EQ(glb.json["skins"][0]["joints"].size(), kHumanBoneCount + kFingerBoneCount);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, GltfMotionTest, testing::Values(&make_glb_encoder, &make_vrma_encoder),
                         [](const auto& kind) { return kind.param == &make_glb_encoder ? "Glb" : "Vrma"; });

}  // namespace
}  // namespace telemime
