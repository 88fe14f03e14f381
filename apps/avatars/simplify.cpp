// SPDX-License-Identifier: Apache-2.0
#include "avatars/simplify.h"

#include <meshoptimizer.h>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "avatars/skinning.h"
#include "telemime/outputs/humanoid.h"

namespace telemime {
namespace {

constexpr double kBend = 0.9;  // rad, of every joint
constexpr auto kGone = std::numeric_limits<std::uint32_t>::max();

struct BentSkeleton {
  std::array<Eigen::Vector3d, kHumanBoneCount> joint;
  std::array<Eigen::Quaterniond, kHumanBoneCount> rotation;  // world from bone
};

BentSkeleton bend(const HumanoidSkeleton& skeleton) {
  // About an axis along no bone, so that every bone's surface is strained.
  const Eigen::Vector3d axis = Eigen::Vector3d(0.5, 0.6, 0.62).normalized();
  HumanoidMotion motion;
  motion.hips = skeleton.position[0];
  motion.rotation.fill(Eigen::Quaterniond(Eigen::AngleAxisd(kBend, axis)));
  motion.rotation[0].setIdentity();
  BentSkeleton result;
  result.joint = humanoid_joints(skeleton, motion);
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    const int parent = kHumanBoneParent[b];
    result.rotation[b] = parent < 0 ? motion.rotation[b]
                                    : result.rotation[static_cast<std::size_t>(parent)] * motion.rotation[b];
  }
  return result;
}

Eigen::Vector3d moved(const HumanoidSkeleton& skeleton, const BentSkeleton& to, const Eigen::Vector3d& point,
                      const SkinWeights& skin) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < skin.bone.size(); ++i) {
    const std::size_t b = skin.bone[i];
    sum += skin.weight[i] * (to.joint[b] + to.rotation[b] * (point - skeleton.position[b]));
  }
  return sum;
}

void keep(std::vector<Eigen::Vector3d>& values, const std::vector<std::uint32_t>& place) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (place[i] != kGone) {
      values[count++] = values[i];
    }
  }
  values.resize(count);
}

}  // namespace

void simplify(const Figure& figure, double error, Triangles& mesh) {
  if (mesh.triangles.empty()) {
    return;
  }
  const BentSkeleton to = bend(figure.skeleton);
  std::vector<float> points;
  points.reserve(3 * mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    const Eigen::Vector3f p = moved(figure.skeleton, to, vertex, skin_weights(figure, vertex)).cast<float>();
    points.insert(points.end(), p.begin(), p.end());
  }
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    indices.insert(indices.end(), t.begin(), t.end());
  }
  constexpr std::size_t kStride = 3 * sizeof(float);
  const std::size_t count = mesh.vertices.size();
  const float scale = meshopt_simplifyScale(points.data(), count, kStride);
  std::vector<std::uint32_t> fewer(indices.size());
  fewer.resize(meshopt_simplify(fewer.data(), indices.data(), indices.size(), points.data(), count, kStride,
                                0, static_cast<float>(error) / scale, 0, nullptr));

  std::vector<std::uint32_t> place(count, kGone);
  for (const std::uint32_t v : fewer) {
    place[v] = 0;
  }
  std::uint32_t next = 0;
  for (std::uint32_t& p : place) {
    p = p == kGone ? kGone : next++;
  }
  keep(mesh.vertices, place);
  keep(mesh.normals, place);
  mesh.triangles.clear();
  for (std::size_t i = 0; i < fewer.size(); i += 3) {
    mesh.triangles.push_back({place[fewer[i]], place[fewer[i + 1]], place[fewer[i + 2]]});
  }
}

}  // namespace telemime
