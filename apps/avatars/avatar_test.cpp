// SPDX-License-Identifier: Apache-2.0
#include "avatars/avatar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "avatars/skinning.h"
#include "avatars/tailor.h"
#include "telemime/body/testing_poses.h"
#include "telemime/core/errors.h"
#include "telemime/outputs/gltf/testing_glb.h"
#include "telemime/outputs/humanoid.h"

namespace telemime {
namespace {

using testing_glb::Glb;
using testing_glb::numbers;

std::vector<Eigen::Vector3f> vectors(const std::vector<float>& values) {
  std::vector<Eigen::Vector3f> result;
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    result.emplace_back(values[i], values[i + 1], values[i + 2]);
  }
  return result;
}

/// The bones that VRM 1.0 requires.
const std::vector<std::string> kRequired = {
    "hips",         "spine",         "head",          "leftUpperLeg",  "leftLowerLeg",
    "leftFoot",     "rightUpperLeg", "rightLowerLeg", "rightFoot",     "leftUpperArm",
    "leftLowerArm", "leftHand",      "rightUpperArm", "rightLowerArm", "rightHand"};

void expect_tpose(const Glb& glb, double stature) {
  std::vector<testing_glb::Local> nodes;
  for (const auto& node : glb.json["nodes"]) {
    testing_glb::Local local;
    EXPECT_FALSE(node.contains("rotation") || node.contains("scale") || node.contains("matrix"));
    if (node.contains("translation")) {
      const std::vector<double> t = node["translation"];
      local.translation = Eigen::Vector3d(t[0], t[1], t[2]);
    }
    nodes.push_back(local);
  }
  const auto& bones = glb.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"];
  const auto at = [&](const std::string& bone) {
    return testing_glb::place_of(glb, nodes, bones[bone]["node"].get<std::size_t>());
  };
  for (const std::string& bone : kRequired) {
    ASSERT_TRUE(bones.contains(bone)) << bone;
  }
  for (const std::string name :
       {"UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Shoulder"}) {
    const Eigen::Vector3d left = at("left" + name);
    const Eigen::Vector3d right = at("right" + name);
    EXPECT_LT((left - Eigen::Vector3d(-right.x(), right.y(), right.z())).norm(), 1e-6) << name;
    EXPECT_GT(left.x(), 0.0) << name;  // facing +z, the person's left is +x
  }
  for (const auto name : kFingerBoneNames) {
    const double out =
        at(std::string(name)).x() - at(name.starts_with("left") ? "leftHand" : "rightHand").x();
    EXPECT_GT(name.starts_with("left") ? out : -out, 0.0) << name;
  }
  const Eigen::Vector3d arm = at("leftHand") - at("leftUpperArm");
  EXPECT_LT(arm.tail<2>().norm(), 1e-6);
  EXPECT_GT(at("head").y(), 0.8 * stature);
}

/// Checks one surface; returns its highest point.
float expect_sound(const Glb& glb, const nlohmann::json& primitive, bool closed) {
  const auto positions = vectors(numbers<float>(glb, primitive["attributes"]["POSITION"]));
  const auto normals = vectors(numbers<float>(glb, primitive["attributes"]["NORMAL"]));
  const auto joints = numbers<std::uint8_t>(glb, primitive["attributes"]["JOINTS_0"]);
  const auto weights = numbers<std::uint16_t>(glb, primitive["attributes"]["WEIGHTS_0"]);
  const auto& index_accessor = glb.json["accessors"][primitive["indices"].get<std::size_t>()];
  std::vector<std::uint32_t> indices;
  if (index_accessor["componentType"] == 5125) {
    indices = numbers<std::uint32_t>(glb, primitive["indices"]);
  } else {
    const auto narrow = numbers<std::uint16_t>(glb, primitive["indices"]);
    indices.assign(narrow.begin(), narrow.end());
  }
  EXPECT_EQ(positions.size(), normals.size());
  EXPECT_EQ(4 * positions.size(), joints.size());
  float top = 0.0F;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    EXPECT_TRUE(positions[v].allFinite());
    EXPECT_NEAR(normals[v].norm(), 1.0F, 1e-3F);
    EXPECT_EQ(weights[4 * v] + weights[4 * v + 1] + weights[4 * v + 2] + weights[4 * v + 3], 65535);
    EXPECT_GT(positions[v].y(), -0.004F);
    top = std::max(top, positions[v].y());
  }
  EXPECT_LT(*std::max_element(joints.begin(), joints.end()), kSkinBoneCount);
  std::size_t inward = 0;
  double volume = 0.0;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    EXPECT_LT(std::max({indices[i], indices[i + 1], indices[i + 2]}), positions.size());
    const Eigen::Vector3f& a = positions[indices[i]];
    const Eigen::Vector3f& b = positions[indices[i + 1]];
    const Eigen::Vector3f& c = positions[indices[i + 2]];
    inward += (b - a).cross(c - a).dot(normals[indices[i]] + normals[indices[i + 1]] +
                                       normals[indices[i + 2]]) < 0.0F;
    volume += static_cast<double>(a.dot(b.cross(c))) / 6.0;
  }
  // At sharp edges a few triangles look another way than the field there.
  EXPECT_LT(static_cast<double>(inward), 0.02 * static_cast<double>(indices.size()) / 3.0);
  if (closed) {
    EXPECT_GT(volume, 0.0);
  }
  return top;
}

void expect_good(const Glb& glb, double stature) {
  const auto& vrm = glb.json["extensions"]["VRMC_vrm"];
  EXPECT_EQ(vrm["specVersion"], "1.0");
  EXPECT_EQ(glb.json["extensionsUsed"][0], "VRMC_vrm");
  EXPECT_EQ(vrm["meta"]["licenseUrl"], "https://vrm.dev/licenses/1.0/");
  EXPECT_FALSE(vrm["meta"]["name"].get<std::string>().empty());
  EXPECT_FALSE(vrm["meta"]["authors"].empty());
  expect_tpose(glb, stature);
  float top = 0.0F;
  for (std::size_t mesh = 0; mesh < glb.json["meshes"].size(); ++mesh) {
    for (const auto& primitive : glb.json["meshes"][mesh]["primitives"]) {
      top = std::max(top, expect_sound(glb, primitive, mesh == 0));
    }
  }
  EXPECT_GT(top, static_cast<float>(0.98 * stature));
  EXPECT_LT(top, static_cast<float>(1.10 * stature));  // hair, a bun, an antenna
  for (const auto& [name, expression] : vrm["expressions"]["preset"].items()) {
    for (const auto& bind : expression["morphTargetBinds"]) {
      const auto& node = glb.json["nodes"][bind["node"].get<std::size_t>()];
      for (const auto& primitive : glb.json["meshes"][node["mesh"].get<std::size_t>()]["primitives"]) {
        EXPECT_LT(bind["index"].get<std::size_t>(), primitive["targets"].size()) << name;
      }
    }
  }
}

TEST(Avatar, IsAPersonInTheTPose) {
  expect_good(testing_glb::parse(make_avatar(Shape{}, avatar_look("plain"))), Shape().stature);
}

TEST(SlowAvatar, EveryLookIsOfOtherProportionsToo) {
  const Shape shape = testing_poses::other_shape();
  for (const AvatarLook& look : kAvatarLooks) {
    SCOPED_TRACE(look.name);
    const Glb glb = testing_glb::parse(make_avatar(shape, look));
    expect_good(glb, shape.stature);
    const auto skeleton = humanoid_skeleton(make_body(shape));
    const std::vector<double> offset =
        glb.json["nodes"][testing_glb::node_named(glb, "leftHand")]["translation"];
    EXPECT_NEAR(offset[0], skeleton.offset(HumanBone::l_hand).x(), 1e-6);
  }
}

TEST(SlowAvatar, ALightOneIsThePersonToo) {
  const auto triangles = [](const Glb& glb) {
    std::size_t count = 0;
    for (const auto& mesh : glb.json["meshes"]) {
      for (const auto& primitive : mesh["primitives"]) {
        count +=
            glb.json["accessors"][primitive["indices"].get<std::size_t>()]["count"].get<std::size_t>() / 3;
      }
    }
    return count;
  };
  for (const AvatarLook& look : kAvatarLooks) {
    SCOPED_TRACE(look.name);
    const Glb whole = testing_glb::parse(make_avatar(Shape{}, look));
    const Glb lighter = testing_glb::parse(make_avatar(Shape{}, light(look)));
    expect_good(lighter, Shape().stature);
    EXPECT_LT(2 * triangles(lighter), triangles(whole));
    EXPECT_LT(triangles(whole), 45000U);
  }
}

TEST(Avatar, TheSameArgumentsGiveTheSameBytes) {
  Shape child;
  child.stature = 1.1;
  const std::string once = make_avatar(child, avatar_look("summer"));
  EXPECT_EQ(once, make_avatar(child, avatar_look("summer")));
  EXPECT_NE(once, make_avatar(child, avatar_look("plain")));
}

TEST(Avatar, BothSidesGetTheMean) {
  Shape shape;
  shape[Segment::l_forearm].length = 1.2;
  shape[Segment::r_forearm].length = 1.0;
  const Glb glb = testing_glb::parse(make_avatar(shape, avatar_look("plain")));
  expect_tpose(glb, shape.stature);
  Shape mean;
  mean[Segment::l_forearm].length = mean[Segment::r_forearm].length = 1.1;
  const std::vector<double> offset =
      glb.json["nodes"][testing_glb::node_named(glb, "leftHand")]["translation"];
  EXPECT_NEAR(offset[0], make_body(mean).forearm_length[0], 1e-6);
}

TEST(Avatar, ABlinkClosesTheEyesOnly) {
  const Glb glb = testing_glb::parse(make_avatar(Shape{}, avatar_look("plain")));
  const auto& primitives = glb.json["meshes"][1]["primitives"];
  std::set<std::string> moving;
  for (const auto& primitive : primitives) {
    const auto positions = vectors(numbers<float>(glb, primitive["attributes"]["POSITION"]));
    for (std::size_t target = 0; target < 2; ++target) {
      const auto moved = vectors(numbers<float>(glb, primitive["targets"][target]["POSITION"]));
      for (std::size_t v = 0; v < moved.size(); ++v) {
        if (moved[v].norm() > 1e-4F) {
          moving.insert(glb.json["materials"][primitive["material"].get<std::size_t>()]["name"]);
          EXPECT_EQ(positions[v].x() >= 0.0F, target == 0);  // blinkLeft comes first
        }
      }
    }
  }
  EXPECT_EQ(moving, (std::set<std::string>{"eye_white", "iris", "lashes", "pupil", "spark"}));
}

TEST(Avatar, EachExpressionMovesItsPartsOfTheFace) {
  for (const char* const look : {"plain", "robot"}) {
    const Glb glb = testing_glb::parse(make_avatar(Shape{}, avatar_look(look)));
    const auto& preset = glb.json["extensions"]["VRMC_vrm"]["expressions"]["preset"];
    EXPECT_EQ(preset.size(), kFaceShapeCount + 1);
    const auto moving = [&](const std::string& name) {
      std::set<std::string> materials;
      const std::size_t target = preset[name]["morphTargetBinds"][0]["index"];
      for (const auto& primitive : glb.json["meshes"][1]["primitives"]) {
        for (const auto& moved : vectors(numbers<float>(glb, primitive["targets"][target]["POSITION"]))) {
          EXPECT_LT(moved.norm(), 0.05F) << name;
          if (moved.norm() > 1e-4F) {
            materials.insert(glb.json["materials"][primitive["material"].get<std::size_t>()]["name"]);
          }
        }
      }
      return materials;
    };
    using Names = std::set<std::string>;
    const bool robot = std::string(look) == "robot";
    for (const char* const vowel : {"aa", "ih", "ou", "ee", "oh"}) {
      EXPECT_EQ(moving(vowel), robot ? Names{"eyes"} : Names{"mouth"}) << vowel;
    }
    EXPECT_EQ(moving("angry"), robot ? Names{"eyes"} : (Names{"brows", "mouth"}));
    EXPECT_EQ(moving("lookLeft"), robot ? Names{"eyes"} : (Names{"iris", "pupil", "spark"}));
  }
}

TEST(Avatar, WhatCannotBeMadeIsRefused) {
  EXPECT_THROW(avatar_look("wizard"), Error);
  for (const double stature : {0.0, -1.7, 10.0, std::nan("")}) {
    Shape shape;
    shape.stature = stature;
    EXPECT_THROW(make_avatar(shape, avatar_look("plain")), Error) << stature;
  }
}

TEST(AvatarLooks, AreFoundByName) {
  for (const AvatarLook& look : kAvatarLooks) {
    EXPECT_EQ(&avatar_look(look.name), &look);
  }
}

}  // namespace
}  // namespace telemime
