// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/gltf/humanoid.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace telemime {

void add_humanoid(GltfDocument& document, const HumanoidSkeleton& skeleton) {
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    const Eigen::Vector3f offset = skeleton.offset(static_cast<HumanBone>(b)).cast<float>();
    nlohmann::ordered_json node = {{"name", kHumanBoneNames[b]}};
    auto children = nlohmann::ordered_json::array();
    for (std::size_t child = b + 1; child < kHumanBoneCount; ++child) {
      if (kHumanBoneParent[child] == static_cast<int>(b)) {
        children.push_back(child);
      }
    }
    if (!children.empty()) {
      node["children"] = std::move(children);
    }
    node["translation"] = std::array<float, 3>{offset.x(), offset.y(), offset.z()};
    add_to(document, "nodes", std::move(node));
  }
  document.json["scenes"][0]["nodes"].push_back(0);
}

std::size_t add_humanoid_skin(GltfDocument& document, const HumanoidSkeleton& skeleton) {
  std::vector<float> matrices;
  auto joints = nlohmann::ordered_json::array();
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    const Eigen::Vector3f p = skeleton.position[b].cast<float>();
    // Column by column; at rest all bones have the axes of the world.
    matrices.insert(matrices.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -p.x(), -p.y(), -p.z(), 1});
    joints.push_back(b);
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

nlohmann::ordered_json human_bones() {
  nlohmann::ordered_json bones;
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    bones[std::string(kHumanBoneNames[b])] = {{"node", b}};
  }
  return bones;
}

}  // namespace telemime
