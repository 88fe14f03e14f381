// SPDX-License-Identifier: Apache-2.0
#include "avatars/surface.h"

#include <meshoptimizer.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "avatars/skinning.h"
#include "telemime/outputs/gltf/humanoid.h"

namespace telemime {
namespace {

constexpr double kBend = 0.9;  // rad, of every joint

// By node: HumanBone, then the fingers.
struct BentSkeleton {
  std::vector<Eigen::Vector3d> rest, joint;
  std::vector<Eigen::Quaterniond> rotation;  // world from bone
};

BentSkeleton bend(const HumanoidSkeleton& skeleton) {
  // About an axis along no bone, so that every bone's surface is strained.
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(kBend, Eigen::Vector3d(0.5, 0.6, 0.62).normalized()));
  BentSkeleton result;
  const auto add = [&](int parent, const Eigen::Vector3d& rest) {
    const auto p = static_cast<std::size_t>(parent);
    result.joint.push_back(
        parent < 0 ? rest : Eigen::Vector3d(result.joint[p] + result.rotation[p] * (rest - result.rest[p])));
    result.rotation.push_back(parent < 0 ? Eigen::Quaterniond::Identity() : result.rotation[p] * turn);
    result.rest.push_back(rest);
  };
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    add(kHumanBoneParent[b], skeleton.position[b]);
  }
  for (std::size_t b = 0; skeleton.fingers && b < kFingerBoneCount; ++b) {
    const HumanBone hand = hand_of_finger_bone(b);
    add(b % 3 == 0 ? static_cast<int>(hand) : static_cast<int>(finger_node(b)) - 1,
        skeleton.position[static_cast<std::size_t>(hand)] + skeleton.fingers->position[b]);
  }
  return result;
}

Eigen::Vector3d moved(const BentSkeleton& to, const Eigen::Vector3d& point, const SkinWeights& skin) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < skin.bone.size(); ++i) {
    const std::size_t b = skin.bone[i];
    sum += skin.weight[i] * (to.joint[b] + to.rotation[b] * (point - to.rest[b]));
  }
  return sum;
}

}  // namespace

void simplify(const Figure& figure, double error, Triangles& mesh) {
  if (mesh.triangles.empty()) {
    return;
  }
  const BentSkeleton to = bend(figure.skeleton);
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    points.emplace_back(moved(to, vertex, skin_weights(figure, vertex)).cast<float>());
  }
  const std::size_t count = points.size();
  const float* const numbers = points.data()->data();
  const float scale = meshopt_simplifyScale(numbers, count, sizeof(Eigen::Vector3f));
  std::vector<std::array<std::uint32_t, 3>> fewer(mesh.triangles.size());
  std::uint32_t* const indices = fewer.data()->data();
  fewer.resize(meshopt_simplify(indices, mesh.triangles.data()->data(), 3 * fewer.size(), numbers, count,
                                sizeof(Eigen::Vector3f), 0, static_cast<float>(error) / scale, 0, nullptr) /
               3);

  std::vector<std::uint32_t> place(count);
  const std::size_t kept = meshopt_optimizeVertexFetchRemap(place.data(), indices, 3 * fewer.size(), count);
  for (std::vector<Eigen::Vector3d>* const values : {&mesh.vertices, &mesh.normals}) {
    meshopt_remapVertexBuffer(values->data(), values->data(), count, sizeof(Eigen::Vector3d), place.data());
    values->resize(kept);
  }
  meshopt_remapIndexBuffer(indices, indices, 3 * fewer.size(), place.data());
  mesh.triangles = std::move(fewer);
}

}  // namespace telemime
