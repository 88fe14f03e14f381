// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/gltf/humanoid.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace telemime {

namespace {

std::array<float, 3> numbers(const Eigen::Vector3d& place) {
  const Eigen::Vector3f p = place.cast<float>();
  return {p.x(), p.y(), p.z()};
}

}  // namespace

void add_humanoid(GltfDocument& document, const HumanoidSkeleton& skeleton) {
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    nlohmann::ordered_json node = {{"name", kHumanBoneNames[b]}};
    auto children = nlohmann::ordered_json::array();
    for (std::size_t child = b + 1; child < kHumanBoneCount; ++child) {
      if (kHumanBoneParent[child] == static_cast<int>(b)) {
        children.push_back(child);
      }
    }
    for (std::size_t child = 0; skeleton.fingers && child < kFingerBoneCount; child += 3) {
      if (static_cast<std::size_t>(hand_of_finger_bone(child)) == b) {
        children.push_back(finger_node(child));
      }
    }
    if (!children.empty()) {
      node["children"] = std::move(children);
    }
    node["translation"] = numbers(skeleton.offset(static_cast<HumanBone>(b)));
    add_to(document, "nodes", std::move(node));
  }
  for (std::size_t b = 0; skeleton.fingers && b < kFingerBoneCount; ++b) {
    nlohmann::ordered_json node = {{"name", kFingerBoneNames[b]}};
    if (b % 3 < 2) {
      node["children"] = {finger_node(b + 1)};
    }
    add_to(document, "nodes", std::move(node));
  }
  if (skeleton.fingers) {
    set_fingers(document, *skeleton.fingers);
  }
  document.json["scenes"][0]["nodes"].push_back(0);
}

void set_fingers(GltfDocument& document, const FingerSkeleton& fingers) {
  for (std::size_t b = 0; b < kFingerBoneCount; ++b) {
    document.json["nodes"][finger_node(b)]["translation"] = numbers(fingers.offset(b));
  }
}

std::size_t add_humanoid_skin(GltfDocument& document, const HumanoidSkeleton& skeleton) {
  std::vector<Eigen::Vector3d> places(skeleton.position.begin(), skeleton.position.end());
  for (std::size_t b = 0; skeleton.fingers && b < kFingerBoneCount; ++b) {
    places.emplace_back(skeleton.position[static_cast<std::size_t>(hand_of_finger_bone(b))] +
                        skeleton.fingers->position[b]);
  }
  std::vector<float> matrices;
  auto joints = nlohmann::ordered_json::array();
  for (const Eigen::Vector3d& place : places) {
    const Eigen::Vector3f p = place.cast<float>();
    // Column by column; at rest all bones have the axes of the world.
    matrices.insert(matrices.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -p.x(), -p.y(), -p.z(), 1});
    joints.push_back(joints.size());
  }
  const std::size_t accessor = add_accessor(document, matrices, "MAT4");
  return add_to(document, "skins", {{"inverseBindMatrices", accessor}, {"skeleton", 0}, {"joints", joints}});
}

std::size_t add_skinned_mesh(GltfDocument& document, const char* name, std::size_t mesh, std::size_t skin) {
  const std::size_t node = add_to(document, "nodes", {{"name", name}, {"mesh", mesh}, {"skin", skin}});
  document.json["scenes"][0]["nodes"].push_back(node);
  return node;
}

std::size_t add_face_nodes(GltfDocument& document) {
  const auto add = [&](std::string_view name) {
    const std::size_t node = add_to(document, "nodes", {{"name", name}});
    document.json["scenes"][0]["nodes"].push_back(node);
    return node;
  };
  const std::size_t first = add(kVrmExpressionNames[0]);
  for (std::size_t i = 1; i < kAnimatedExpressionCount; ++i) {
    add(kVrmExpressionNames[i]);
  }
  add("lookAt");
  return first;
}

nlohmann::ordered_json animated_expressions(std::size_t first_node) {
  nlohmann::ordered_json preset;
  for (std::size_t i = 0; i < kAnimatedExpressionCount; ++i) {
    preset[std::string(kVrmExpressionNames[i])] = {{"node", first_node + i}};
  }
  return {{"preset", preset}};
}

nlohmann::ordered_json animated_look_at(std::size_t first_node) {
  return {{"node", first_node + kAnimatedExpressionCount}, {"offsetFromHeadBone", {0.0, 0.06, 0.0}}};
}

nlohmann::ordered_json human_bones(const HumanoidSkeleton& skeleton) {
  nlohmann::ordered_json bones;
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    bones[std::string(kHumanBoneNames[b])] = {{"node", b}};
  }
  for (std::size_t b = 0; skeleton.fingers && b < kFingerBoneCount; ++b) {
    bones[std::string(kFingerBoneNames[b])] = {{"node", finger_node(b)}};
  }
  return bones;
}

}  // namespace telemime
