// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <string_view>

#include "lab/synth/mesh_files.h"
#include "telemime/body/face_eye.h"
#include "telemime/body/face_model.h"

namespace telemime::mesh_files {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3f;
using Json = nlohmann::json;

// In the meshes a finger bends where it leaves the palm. The joint of people lies farther back, by this share
// of its distance from the wrist (after Buchholz, Armstrong & Goldstein, Ergonomics 35, 1992).
constexpr float kKnuckleBack = 0.15f;
constexpr float kMostOfTarget = 3.0f;  // shares of one target; a larger share would distort the person
constexpr std::string_view kHead = "____head";
constexpr std::string_view kTail = "____tail";

std::vector<Vector3f> triples(const std::vector<float>& numbers) {
  std::vector<Vector3f> points;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  }
  return points;
}

// Shapes against the base mesh. One file has them all: 16-bit differences in thousandths, in the order of
// their names.
class Targets {
 public:
  Targets(const fs::path& folder, std::size_t vertices)
      : list_(folder / "src/json/targets/target-list.json"),
        data_(folder / "public/data/targets/targets.bin") {
    with_file(list_, [&](const Json& json) {
      for (const auto& [name, groups] : json.at("targets").items()) {
        places_.emplace(name, 0);
      }
    });
    std::size_t place = 0;
    for (auto& [name, at] : places_) {
      at = place++;
    }
    // A list of other shapes than those of the file would give another person.
    std::error_code error;
    const std::uintmax_t size = fs::file_size(data_, error);
    if (error) {
      refuse(data_, error.message());
    }
    if (size != places_.size() * vertices * 3 * sizeof(std::int16_t)) {
      refuse(data_, "it does not have the shapes that " + list_.string() + " lists");
    }
  }

  // Adds a share of a target to the vertices (in decimetres).
  void add(const std::string& name, float share, std::vector<Vector3f>& vertices) const {
    const auto found = places_.find("data/targets/" + name + ".target");
    if (found == places_.end()) {
      refuse(list_, "it lacks " + name);
    }
    std::vector<std::int16_t> differences(vertices.size() * 3);
    const std::size_t size = differences.size() * sizeof(differences[0]);
    std::ifstream in(data_, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(found->second * size));
    if (!in.read(reinterpret_cast<char*>(differences.data()), static_cast<std::streamsize>(size))) {
      refuse(data_, "it cannot be read");
    }
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      for (std::size_t k = 0; k < 3; ++k) {
        vertices[v][static_cast<Eigen::Index>(k)] +=
            share * 1e-3f * static_cast<float>(differences[3 * v + k]);
      }
    }
  }

 private:
  fs::path list_, data_;
  std::map<std::string, std::size_t> places_;
};

const MeshBone& bone_named(const std::vector<MeshBone>& bones, const std::string& name) {
  const auto found =
      std::find_if(bones.begin(), bones.end(), [&](const MeshBone& b) { return b.name == name; });
  if (found == bones.end()) {
    throw std::out_of_range("it has no bone " + name);
  }
  return *found;
}

// Those that pose_mesh() needs are there, and fingers have no other bones.
void check_names(const std::vector<MeshBone>& bones) {
  for (const char* name : {"spine04", "neck01", "head", "jaw", "special03"}) {
    bone_named(bones, name);
  }
  std::ptrdiff_t phalanges = 0;
  for (const std::string side : {".L", ".R"}) {
    for (const char* name : {"upperarm01", "lowerarm01", "wrist", "eye", "levator05"}) {
      bone_named(bones, name + side);
    }
    for (int finger = 1; finger <= 5; ++finger) {
      for (int k = 1; k <= 3; ++k, ++phalanges) {
        bone_named(bones, "finger" + std::to_string(finger) + "-" + std::to_string(k) + side);
      }
    }
  }
  const auto of_finger = [](const MeshBone& bone) { return bone.name.starts_with("finger"); };
  if (std::count_if(bones.begin(), bones.end(), of_finger) != phalanges) {
    throw std::out_of_range("a finger has another number of bones than three");
  }
}

}  // namespace

std::vector<MeshBone> read_bones(const Json& mesh, const std::vector<Vector3f>& vertices) {
  const Json& places = mesh.at("metadata").at("joint_pos_idxs");
  const auto middle = [&](const std::string& joint) {
    Vector3f sum = Vector3f::Zero();
    const std::vector<std::size_t> around = places.at(joint).get<std::vector<std::size_t>>();
    for (const std::size_t v : around) {
      sum += vertices.at(v);
    }
    if (around.empty()) {
      throw std::out_of_range(joint + " is nowhere");
    }
    return Vector3f(sum / static_cast<float>(around.size()));
  };
  std::vector<MeshBone> bones;
  const Json& nodes = mesh.at("bones");
  for (std::size_t i = 0; i + 1 < nodes.size(); i += 2) {
    MeshBone bone;
    bone.name = nodes[i + 1].at("name").get<std::string>();
    const int parent = nodes[i].at("parent").get<int>();
    bone.parent = parent < 0 ? -1 : parent / 2;
    if (bone.parent >= static_cast<int>(bones.size())) {
      throw std::out_of_range("a bone comes before its parent");
    }
    bone.head = middle(bone.name + std::string(kHead));
    bone.tail = middle(bone.name + std::string(kTail));
    bones.push_back(std::move(bone));
  }
  check_names(bones);
  return bones;
}

std::vector<Vector3f> shaped(const fs::path& folder, const MeshLook& look, const Json& mesh,
                             const std::vector<MeshPart::Triangle>& skin) {
  std::vector<Vector3f> vertices = triples(mesh.at("vertices").get<std::vector<float>>());
  const Targets targets(folder, vertices.size());
  for (const auto& [name, share] : look.targets) {
    targets.add(name, share, vertices);
  }
  // A length of the body grows evenly with the share of a target.
  const auto reach = [&](float wanted, const std::string& more, const std::string& less, const auto& length) {
    const float now = kUnit * length(vertices);
    const std::string& target = wanted > now ? more : less;
    std::vector<Vector3f> changed = vertices;
    targets.add(target, 1.0f, changed);
    const float share = (wanted - now) / (kUnit * length(changed) - now);
    if (!(std::abs(share) < kMostOfTarget)) {
      throw std::out_of_range(target + " does not lead to the length of the person");
    }
    targets.add(target, share, vertices);
  };
  const auto height = [&](const std::vector<Vector3f>& of) {
    float low = std::numeric_limits<float>::max();
    float high = -low;
    for (const MeshPart::Triangle& t : skin) {
      for (const int v : t.vertex) {
        low = std::min(low, of.at(static_cast<std::size_t>(v)).y());
        high = std::max(high, of[static_cast<std::size_t>(v)].y());
      }
    }
    return high - low;
  };
  reach(look.stature, look.tall, look.tall, height);
  for (const std::string side : {"l", "r"}) {
    const auto bone_length = [&](const std::string& from, const std::string& to) {
      return [&mesh, from, to, end = side == "l" ? ".L" : ".R"](const std::vector<Vector3f>& of) {
        Vector3f difference = Vector3f::Zero();
        for (const MeshBone& bone : read_bones(mesh, of)) {
          difference += bone.name == to + end     ? bone.head
                        : bone.name == from + end ? Vector3f(-bone.head)
                                                  : Vector3f::Zero();
        }
        return difference.norm();
      };
    };
    std::string arm = "armslegs/";
    arm += side;
    const auto target = [&](const std::string& name) { return arm + name; };
    reach(look.hand / (1.0f - kKnuckleBack), target("-hand-scale-incr"), target("-hand-scale-decr"),
          bone_length("wrist", "finger3-1"));
    reach(look.upper_arm, target("-upperarm-scale-horiz-incr"), target("-upperarm-scale-horiz-decr"),
          bone_length("upperarm01", "lowerarm01"));
    reach(look.forearm, target("-lowerarm-scale-horiz-incr"), target("-lowerarm-scale-horiz-decr"),
          bone_length("lowerarm01", "wrist"));
  }
  for (Vector3f& v : vertices) {
    v *= kUnit;
  }
  return vertices;
}

Eigen::Matrix3f turn_of_face(const std::vector<MeshBone>& bones) {
  const auto bone = [&](const std::string& name) -> const MeshBone& { return bone_named(bones, name); };
  // Points of MediaPipe's face mesh; an eyeball has its middle behind the iris.
  constexpr std::size_t kNose = 1;
  constexpr std::size_t kChin = 152;
  constexpr std::size_t kLeftMouth = 291;
  constexpr std::size_t kRightMouth = 61;
  const FacePoints& face = canonical_face();
  const Eigen::Vector3d behind(0.0, 0.0, kEyeball);
  const std::array<std::pair<Vector3f, Eigen::Vector3d>, 6> pairs = {{
      {bone("eye.L").head, face[kLeftIris] + behind},
      {bone("eye.R").head, face[kRightIris] + behind},
      {bone("special03").tail, face[kNose]},
      {bone("levator05.L").tail, face[kLeftMouth]},
      {bone("levator05.R").tail, face[kRightMouth]},
      {bone("jaw").tail, face[kChin]},
  }};
  Eigen::Matrix<float, 3, 6> from;
  Eigen::Matrix<float, 3, 6> to;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    to.col(column) = pairs[i].first;
    from.col(column) = Vector3f(1.0f, -1.0f, -1.0f).cwiseProduct(pairs[i].second.cast<float>());
  }
  const Eigen::Matrix3f scaled = Eigen::umeyama(from, to, true).topLeftCorner<3, 3>();
  return scaled / scaled.col(0).norm();
}

void move_knuckles(MeshPart& body, std::vector<MeshBone>& bones) {
  constexpr float kBorder = 0.008f;  // m, half the width over which the skin changes from one to the other
  const auto bone = [&](const std::string& name) {
    return static_cast<int>(&bone_named(bones, name) - bones.data());
  };
  for (const std::string side : {".L", ".R"}) {
    const Vector3f wrist = bones[static_cast<std::size_t>(bone("wrist" + side))].head;
    for (int finger = 2; finger <= 5; ++finger) {
      const int moving = bone("finger" + std::to_string(finger) + "-1" + side);
      const int fixed = bone("metacarpal" + std::to_string(finger - 1) + side);
      MeshBone& first = bones[static_cast<std::size_t>(moving)];
      first.head += kKnuckleBack * (wrist - first.head);
      const Vector3f along = (first.tail - first.head).normalized();
      for (std::size_t v = 0; v < body.vertices.size(); ++v) {
        Eigen::Vector4f& weights = body.weights[v];
        std::array<int, 4>& of = body.bones[v];
        float both = 0.0f;
        for (std::size_t k = 0; k < 4; ++k) {
          float& weight = weights[static_cast<Eigen::Index>(k)];
          if (of[k] == moving || of[k] == fixed) {
            both += weight;
            weight = 0.0f;
          }
        }
        if (both == 0.0f) {
          continue;
        }
        const float t = (body.vertices[v] - first.head).dot(along) / kBorder;
        const float s = std::clamp(0.5f + 0.5f * t, 0.0f, 1.0f);
        const float share = s * s * (3.0f - 2.0f * s);
        // The least of the other weights makes room if four bones move the vertex.
        for (const auto& [to, weight] :
             {std::pair{moving, both * share}, std::pair{fixed, both * (1.0f - share)}}) {
          if (weight > 0.0f) {
            Eigen::Index least = 0;
            weights.minCoeff(&least);
            of[static_cast<std::size_t>(least)] = to;
            weights[least] = weight;
          }
        }
        weights /= weights.sum();
      }
    }
  }
}

}  // namespace telemime::mesh_files
