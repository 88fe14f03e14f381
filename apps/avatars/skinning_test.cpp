// SPDX-License-Identifier: Apache-2.0
#include "avatars/skinning.h"

#include <gtest/gtest.h>

#include <map>

#include "telemime/core/random.h"
#include "telemime/outputs/gltf/humanoid.h"

namespace telemime {
namespace {

using Eigen::Vector3d;

std::map<HumanBone, double> weights_at(const Figure& figure, const Vector3d& point) {
  const SkinWeights skin = skin_weights(figure, point);
  std::map<HumanBone, double> result;
  for (std::size_t i = 0; i < 4; ++i) {
    result[static_cast<HumanBone>(skin.bone[i])] += skin.weight[i];
  }
  return result;
}

class SkinningTest : public testing::Test {
 protected:
  const Figure figure_ = make_figure(make_body(Shape{}));
};

TEST_F(SkinningTest, MiddlesOfBonesFollowThem) {
  using enum HumanBone;
  for (const HumanBone bone : {head, l_upper_arm, r_upper_arm, l_lower_arm, r_lower_arm, l_upper_leg,
                               r_upper_leg, l_lower_leg, r_lower_leg}) {
    const auto i = static_cast<std::size_t>(bone);
    const Vector3d middle = 0.5 * (figure_.skeleton.position[i] + figure_.skeleton.end[i]);
    EXPECT_GT(weights_at(figure_, middle)[bone], 0.95) << kHumanBoneNames[i];
  }
  EXPECT_GT(weights_at(figure_, figure_.at(l_hand) + Vector3d(0.05, 0.0, -0.01))[l_hand], 0.999);
  EXPECT_GT(weights_at(figure_, figure_.at(hips) + Vector3d(0.0, -0.01, 0.1))[hips], 0.6);
}

TEST_F(SkinningTest, FingersFollowTheirBonesAlone) {
  const FingerSkeleton& fingers = figure_.skeleton.fingers.value();
  for (std::size_t b = 0; b < kFingerBoneCount; ++b) {
    const Vector3d& wrist = figure_.at(hand_of_finger_bone(b));
    const double far = b % 3 == 2 ? 0.9 : 0.5;
    const Vector3d point = wrist + (1.0 - far) * fingers.position[b] + far * fingers.end[b];
    EXPECT_GT(weights_at(figure_, point)[static_cast<HumanBone>(finger_node(b))], 0.9) << kFingerBoneNames[b];
  }
}

TEST_F(SkinningTest, AJointSharesItsSkinEvenly) {
  using enum HumanBone;
  auto elbow = weights_at(figure_, figure_.at(l_lower_arm));
  EXPECT_NEAR(elbow[l_upper_arm], 0.5, 1e-9);
  EXPECT_NEAR(elbow[l_lower_arm], 0.5, 1e-9);
  auto crotch = weights_at(figure_, {0.0, figure_.at(l_lower_leg).y(), 0.0});
  EXPECT_NEAR(crotch[l_upper_leg], crotch[r_upper_leg], 1e-9);
}

TEST_F(SkinningTest, WeightsSumToOneAndNeverJump) {
  Random random(3);
  const auto all = [&](const Vector3d& p) {
    const SkinWeights skin = skin_weights(figure_, p);
    Eigen::Matrix<double, static_cast<int>(kSkinBoneCount), 1> w;
    w.setZero();
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_GE(skin.weight[i], 0.0);
      w[skin.bone[i]] += skin.weight[i];
    }
    return w;
  };
  for (int i = 0; i < 3000; ++i) {
    const Vector3d p(random.uniform(-0.9, 0.9), random.uniform(0.0, 1.75), random.uniform(-0.15, 0.2));
    const auto here = all(p);
    EXPECT_NEAR(here.sum(), 1.0, 1e-9);
    if (std::abs(p.x()) < 0.045 || std::abs(p.x()) > figure_.at(HumanBone::l_hand).x() - 0.001) {
      continue;  // near the middle the two sides meet: another test looks there; and fingers part
    }
    const auto beside = all(p + Vector3d(0.0005, 0.0005, 0.0005));
    EXPECT_LT((here - beside).cwiseAbs().maxCoeff(), 0.06) << p.transpose();
  }
}

TEST_F(SkinningTest, TheOtherSideIsTheMirrorImage) {
  using enum HumanBone;
  auto left = weights_at(figure_, {0.30, 1.38, 0.01});
  auto right = weights_at(figure_, {-0.30, 1.38, 0.01});
  EXPECT_DOUBLE_EQ(left[l_upper_arm], right[r_upper_arm]);
  EXPECT_EQ(right[l_upper_arm], 0.0);
}

}  // namespace
}  // namespace telemime
