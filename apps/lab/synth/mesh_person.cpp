// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/mesh_person.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "telemime/body/face_eye.h"
#include "telemime/body/face_model.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3f;
using Json = nlohmann::json;

constexpr float kUnit = 0.1f;  // m; MakeHuman counts in decimetres
// In the meshes a finger bends where it leaves the palm. The joint of people lies farther back, by this share
// of its distance from the wrist (after Buchholz, Armstrong & Goldstein, Ergonomics 35, 1992).
constexpr float kKnuckleBack = 0.15f;
constexpr std::string_view kHead = "____head";
constexpr std::string_view kTail = "____tail";
constexpr const char* kRemedy = "Fetch the people again: apps/lab/people.sh DIR.";

[[noreturn]] void refuse(const fs::path& file, const std::string& reason) {
  throw Error(ErrorKind::input, file.string() + " cannot be used: " + reason, kRemedy);
}

Json read_json(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    refuse(file, "it cannot be opened");
  }
  Json json = Json::parse(in, nullptr, false);
  if (json.is_discarded()) {
    refuse(file, "it is not JSON");
  }
  return json;
}

// Runs `read` and names the file if a field is missing or of another type.
template <typename Read>
auto with_file(const fs::path& file, const Read& read) {
  try {
    return read(read_json(file));
  } catch (const Json::exception& error) {
    refuse(file, error.what());
  } catch (const std::out_of_range&) {
    refuse(file, "an index is out of range");
  }
}

// The triangles of a mesh in the format of three.js version 3, whose faces have a bit field each: 1 four
// corners, 2 a material, 8 texels. Faces of other materials than `material` are left out; -1: none is.
std::vector<MeshPart::Triangle> read_triangles(const Json& mesh, int material) {
  const std::vector<int> faces = mesh.at("faces").get<std::vector<int>>();
  std::vector<MeshPart::Triangle> triangles;
  for (std::size_t i = 0; i < faces.size();) {
    const int kind = faces[i++];
    const std::size_t corners = (kind & 1) != 0 ? 4 : 3;
    const auto four = [&](std::array<int, 4>& to) {
      for (std::size_t k = 0; k < corners; ++k) {
        to[k] = faces.at(i++);
      }
    };
    std::array<int, 4> v{};
    std::array<int, 4> t{};
    four(v);
    const int of = (kind & 2) != 0 ? faces.at(i++) : 0;
    if ((kind & 8) != 0) {
      four(t);
    }
    if ((kind & ~11) != 0) {
      throw std::out_of_range("kind of face");
    }
    if (material >= 0 && of != material) {
      continue;
    }
    for (std::size_t k = 2; k < corners; ++k) {
      triangles.push_back({{v[0], v[k - 1], v[k]}, {t[0], t[k - 1], t[k]}, Surface::shirt});
    }
  }
  return triangles;
}

// What the meshes of the body and of what it wears have in common: triangles, texels, weights.
MeshPart read_part(const Json& mesh, int material, std::size_t vertices, std::size_t bones) {
  MeshPart part;
  part.triangles = read_triangles(mesh, material);
  const std::vector<float> uv = mesh.at("uvs").at(0).get<std::vector<float>>();
  for (std::size_t i = 0; i + 1 < uv.size(); i += 2) {
    part.texels.emplace_back(uv[i], uv[i + 1]);
  }
  const std::size_t most = mesh.at("influencesPerVertex").get<std::size_t>();
  const std::vector<float> weights = mesh.at("skinWeights").get<std::vector<float>>();
  const std::vector<int> indices = mesh.at("skinIndices").get<std::vector<int>>();
  part.bones.resize(vertices);
  part.weights.assign(vertices, Eigen::Vector4f::Zero());
  for (std::size_t v = 0; v < vertices; ++v) {
    for (std::size_t k = 0; k < std::min<std::size_t>(most, 4); ++k) {
      part.weights[v][static_cast<Eigen::Index>(k)] = weights.at(v * most + k);
      // Every bone is two nodes there: its head, which moves the vertices, and its tail.
      part.bones[v][k] = indices.at(v * most + k) / 2;
    }
    const float sum = part.weights[v].sum();
    part.weights[v] = sum > 0.0f ? Eigen::Vector4f(part.weights[v] / sum) : Eigen::Vector4f::UnitX();
    if (*std::max_element(part.bones[v].begin(), part.bones[v].end()) >= static_cast<int>(bones)) {
      throw std::out_of_range("bone");
    }
  }
  for (const MeshPart::Triangle& t : part.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (t.vertex[k] < 0 || t.texel[k] < 0 || static_cast<std::size_t>(t.vertex[k]) >= vertices ||
          static_cast<std::size_t>(t.texel[k]) >= part.texels.size()) {
        throw std::out_of_range("corner");
      }
    }
  }
  return part;
}

// Linear light with the gamma of 2 that the renderer uses.
cv::Mat read_texture(const fs::path& file) {
  cv::Mat image = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  if (image.empty() || image.depth() != CV_8U) {
    refuse(file, "it is not a picture of 8 bits");
  }
  if (image.channels() != 4) {
    cv::cvtColor(image, image, image.channels() == 1 ? cv::COLOR_GRAY2BGRA : cv::COLOR_BGR2BGRA);
  }
  cv::Mat texture;
  image.convertTo(texture, CV_32FC4, 1.0 / 255.0);
  texture.forEach<cv::Vec4f>([](cv::Vec4f& c, const int*) {
    for (int k = 0; k < 3; ++k) {
      c[k] *= c[k];
    }
  });
  return texture;
}

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
  explicit Targets(const fs::path& folder)
      : list_(folder / "src/json/targets/target-list.json"),
        data_(folder / "public/data/targets/targets.bin") {
    with_file(list_, [&](const Json& json) {
      for (const auto& [name, groups] : json.at("targets").items()) {
        places_.emplace(name, 0);
      }
      return 0;
    });
    std::size_t place = 0;
    for (auto& [name, at] : places_) {
      at = place++;
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
      refuse(data_, "it is too short");
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

std::vector<MeshBone> read_bones(const Json& mesh, const std::vector<Vector3f>& vertices) {
  const Json& places = mesh.at("metadata").at("joint_pos_idxs");
  const auto middle = [&](const std::string& joint) {
    Vector3f sum = Vector3f::Zero();
    const std::vector<std::size_t> around = places.at(joint).get<std::vector<std::size_t>>();
    for (const std::size_t v : around) {
      sum += vertices.at(v);
    }
    return Vector3f(sum / static_cast<float>(std::max<std::size_t>(around.size(), 1)));
  };
  std::vector<MeshBone> bones;
  const Json& nodes = mesh.at("bones");
  for (std::size_t i = 0; i + 1 < nodes.size(); i += 2) {
    MeshBone bone;
    bone.name = nodes[i + 1].at("name").get<std::string>();
    const int parent = nodes[i].at("parent").get<int>();
    bone.parent = parent < 0 ? -1 : parent / 2;
    if (bone.parent >= static_cast<int>(bones.size())) {
      throw std::out_of_range("parent");
    }
    bone.head = middle(bone.name + std::string(kHead));
    bone.tail = middle(bone.name + std::string(kTail));
    bones.push_back(std::move(bone));
  }
  return bones;
}

// The base mesh in the shape of the look, in decimetres. `skin`: its triangles without the helpers.
std::vector<Vector3f> shaped(const fs::path& folder, const MeshLook& look, const Json& mesh,
                             const std::vector<MeshPart::Triangle>& skin) {
  std::vector<Vector3f> vertices = triples(mesh.at("vertices").get<std::vector<float>>());
  const Targets targets(folder);
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
    const auto target = [&](const std::string& name) { return "armslegs/" + side + "-" + name; };
    reach(look.hand / (1.0f - kKnuckleBack), target("hand-scale-incr"), target("hand-scale-decr"),
          bone_length("wrist", "finger3-1"));
    reach(look.upper_arm, target("upperarm-scale-horiz-incr"), target("upperarm-scale-horiz-decr"),
          bone_length("upperarm01", "lowerarm01"));
    reach(look.forearm, target("lowerarm-scale-horiz-incr"), target("lowerarm-scale-horiz-decr"),
          bone_length("lowerarm01", "wrist"));
  }
  return vertices;
}

// The turn of the average face that brings its eyes, nose, mouth and chin nearest to those of the person.
Eigen::Matrix3f turn_of_face(const std::vector<MeshBone>& bones) {
  const auto bone = [&](const std::string& name) -> const MeshBone& {
    return *std::find_if(bones.begin(), bones.end() - 1, [&](const MeshBone& b) { return b.name == name; });
  };
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

// Something that is worn: each of its vertices is given by three of the body's and a distance from them.
// `hidden` is set at the vertices of the body that it covers.
MeshPart read_worn(const fs::path& folder, const std::string& name, const std::string& texture,
                   const std::vector<Vector3f>& body, std::size_t bones, std::vector<bool>& hidden) {
  const fs::path file = folder / (name + ".json");
  return with_file(file, [&](const Json& mesh) {
    const auto corners = mesh.at("ref_vIdxs").get<std::vector<std::array<std::size_t, 3>>>();
    const auto shares = mesh.at("weights").get<std::vector<std::array<float, 3>>>();
    const auto offsets = mesh.at("offsets").get<std::vector<std::array<float, 3>>>();
    MeshPart part = read_part(mesh, -1, corners.size(), bones);
    for (std::size_t v = 0; v < corners.size(); ++v) {
      Vector3f at = kUnit * Vector3f(offsets.at(v)[0], offsets[v][1], offsets[v][2]);
      for (std::size_t k = 0; k < 3; ++k) {
        at += shares.at(v)[k] * body.at(corners[v][k]);
      }
      part.vertices.push_back(at);
    }
    const Json& covered = mesh.at("metadata").at("deleteVerts");
    for (std::size_t v = 0; v < covered.size() && v < hidden.size(); ++v) {
      hidden[v] = hidden[v] || covered[v].get<int>() != 0;
    }
    const std::string picture =
        texture.empty() ? mesh.at("materials").at(0).at("mapDiffuse").get<std::string>() : texture;
    part.texture = read_texture(folder / picture);
    return part;
  });
}

Surface surface_of(const MeshPart& part, const MeshPart::Triangle& triangle,
                   const std::vector<bool>& of_head) {
  const auto v = static_cast<std::size_t>(triangle.vertex[0]);
  Eigen::Index strongest = 0;
  part.weights[v].maxCoeff(&strongest);
  return of_head[static_cast<std::size_t>(part.bones[v][static_cast<std::size_t>(strongest)])] ? Surface::head
                                                                                               : Surface::arm;
}

// Moves the knuckles to where those of people are, and the border between the skin that moves with the palm
// and that which moves with the finger.
void move_knuckles(MeshPart& body, std::vector<MeshBone>& bones) {
  constexpr float kBorder = 0.008f;  // m, half the width over which the skin changes from one to the other
  const auto bone = [&](const std::string& name) {
    for (std::size_t i = 0; i < bones.size(); ++i) {
      if (bones[i].name == name) {
        return static_cast<int>(i);
      }
    }
    throw std::out_of_range("bone");
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

template <std::size_t N>
std::string pick(Random& random, const std::array<const char*, N>& names) {
  return names[random.below(static_cast<std::uint32_t>(N))];
}

}  // namespace

MeshLook random_mesh_look(bool long_sleeves, Random& random) {
  const bool woman = random.uniform() < 0.5;
  const std::string sex = woman ? "female" : "male";
  const std::string origin = pick(random, std::array{"african", "asian", "caucasian"});
  const std::string age = pick(random, std::array{"young", "young", "middleage", "old"});
  MeshLook look;
  // Between two ages, two builds and two heights.
  const float old = age == "old" ? 0.8f : age == "middleage" ? 0.5f : 0.0f;
  const auto build = static_cast<float>(random.uniform(-0.5, 0.6));
  const std::string muscle = pick(random, std::array{"minmuscle", "averagemuscle", "maxmuscle"});
  for (const auto& [years, share] : {std::pair{"young", 1.0f - old}, std::pair{"old", old}}) {
    if (share == 0.0f) {
      continue;
    }
    const std::string of = sex + "-" + years + "-";
    look.targets.emplace_back("macrodetails/" + origin + "-" + sex + "-" + years, share);
    look.targets.emplace_back("macrodetails/universal-" + of + muscle + "-averageweight",
                              share * (1.0f - std::abs(build)));
    look.targets.emplace_back(
        "macrodetails/universal-" + of + muscle + (build < 0.0f ? "-minweight" : "-maxweight"),
        share * std::abs(build));
  }
  look.tall = "macrodetails/height/" + sex + "-young-" + muscle + "-averageweight-maxheight";
  // Means and spreads of statures: NCD-RisC, eLife 5, e13410, 2016, adults born in 1996, rounded.
  look.stature = static_cast<float>(woman ? random.normal(1.62, 0.06) : random.normal(1.74, 0.07));
  const auto share_of_stature = [&](double share) {
    return look.stature * static_cast<float>(share * random.normal(1.0, 0.03));
  };
  look.upper_arm = share_of_stature(woman ? 0.1586 : 0.1618);
  look.forearm = share_of_stature(woman ? 0.1523 : 0.1545);
  look.hand = share_of_stature(woman ? 0.0450 : 0.0495);
  look.skin = age + "_" + origin + "_" + sex;
  if (long_sleeves) {
    look.clothes =
        woman ? "female_elegantsuit01"
              : pick(random, std::array{"male_casualsuit01", "male_casualsuit02", "male_casualsuit03",
                                        "male_casualsuit05", "male_elegantsuit01"});
  } else {
    look.clothes =
        woman ? pick(random, std::array{"female_casualsuit01", "female_casualsuit02"})
              : pick(random, std::array{"male_casualsuit04", "male_casualsuit06", "male_worksuit01"});
  }
  look.hair = woman ? pick(random, std::array{"bob02", "long01", "ponytail01", "Braid01"})
                    : pick(random, std::array{"short01", "short02", "short04", "afro01"});
  look.eyes = pick(random, std::array{"brown", "brownlight", "blue", "green", "grey"});
  return look;
}

MeshPerson read_mesh_person(const fs::path& folder, const MeshLook& look) {
  const fs::path data = folder / "public/data";
  MeshPerson person;
  MeshPart body;
  const fs::path base = data / "models/human_full_size.json";
  with_file(base, [&](const Json& mesh) {
    // The other materials are helpers: places of joints, frames for clothes.
    const Json& materials = mesh.at("materials");
    const auto material = std::find_if(materials.begin(), materials.end(), [](const Json& each) {
      return each.at("DbgName").get<std::string>() == "body";
    });
    const auto of_body = static_cast<int>(std::distance(materials.begin(), material));
    std::vector<Vector3f> vertices = shaped(folder, look, mesh, read_triangles(mesh, of_body));
    for (Vector3f& v : vertices) {
      v *= kUnit;
    }
    person.bones = read_bones(mesh, vertices);
    body = read_part(mesh, of_body, vertices.size(), person.bones.size());
    body.vertices = std::move(vertices);
    move_knuckles(body, person.bones);
    person.rest_from_face = turn_of_face(person.bones);
    return 0;
  });

  const fs::path skin = data / "skins" / look.skin;
  body.texture = with_file(skin / (look.skin + ".json"), [&](const Json& json) {
    return read_texture(skin / json.at("mapDiffuse").get<std::string>());
  });
  std::vector<bool> of_head;
  for (const MeshBone& bone : person.bones) {
    of_head.push_back(bone.name == "head" ||
                      (bone.parent >= 0 && of_head[static_cast<std::size_t>(bone.parent)]));
  }
  for (MeshPart::Triangle& triangle : body.triangles) {
    triangle.surface = surface_of(body, triangle, of_head);
  }

  struct Worn {
    const char* kind;
    std::string name;
    std::string texture;
    Surface surface;
    bool transparent;
  };
  std::vector<bool> hidden(body.vertices.size(), false);
  for (const Worn& worn :
       {Worn{"clothes", look.clothes, "", Surface::shirt, false},
        Worn{"eyes", "Low-Poly", "textures/" + look.eyes + "_eye.png", Surface::head, false},
        Worn{"eyebrows", "Eyebrows_01", "", Surface::head, true},
        Worn{"hair", look.hair, "", Surface::hair, true}}) {
    MeshPart part = read_worn(data / "proxies" / worn.kind / worn.name, worn.name, worn.texture,
                              body.vertices, person.bones.size(), hidden);
    for (MeshPart::Triangle& triangle : part.triangles) {
      triangle.surface = worn.surface;
    }
    part.transparent = worn.transparent;
    person.parts.push_back(std::move(part));
  }
  std::erase_if(body.triangles, [&](const MeshPart::Triangle& t) {
    return std::all_of(t.vertex.begin(), t.vertex.end(),
                       [&](int v) { return hidden[static_cast<std::size_t>(v)]; });
  });
  person.parts.insert(person.parts.begin(), std::move(body));
  return person;
}

}  // namespace telemime
