// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/mesh_person.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "lab/synth/mesh_files.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace mesh_files {

void refuse(const std::filesystem::path& file, const std::string& reason) {
  throw Error(ErrorKind::input, file.string() + " cannot be used: " + reason,
              "Give the folder that apps/lab/people.sh prints; delete it first to fetch it again.");
}

nlohmann::json read_json(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    refuse(file, "it cannot be opened");
  }
  nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  if (json.is_discarded()) {
    refuse(file, "it is not JSON");
  }
  return json;
}

}  // namespace mesh_files

namespace {

namespace fs = std::filesystem;
using Eigen::Vector3f;
using Json = nlohmann::json;
using mesh_files::kUnit;
using mesh_files::refuse;
using mesh_files::with_file;

constexpr float kMostTexel = 100.0f;  // widths of a picture, which repeats

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
      throw std::out_of_range("a face is of an unknown kind");
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
    if (!(std::abs(uv[i]) < kMostTexel && std::abs(uv[i + 1]) < kMostTexel)) {
      throw std::out_of_range("a texel lies far outside its picture");
    }
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
      const int node = indices.at(v * most + k);
      if (node < 0 || node / 2 >= static_cast<int>(bones) || !(weights[v * most + k] >= 0.0f)) {
        throw std::out_of_range("a vertex follows a bone that does not exist");
      }
      part.bones[v][k] = node / 2;
    }
    const float sum = part.weights[v].sum();
    part.weights[v] = sum > 0.0f ? Eigen::Vector4f(part.weights[v] / sum) : Eigen::Vector4f::UnitX();
  }
  for (const MeshPart::Triangle& t : part.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (t.vertex[k] < 0 || t.texel[k] < 0 || static_cast<std::size_t>(t.vertex[k]) >= vertices ||
          static_cast<std::size_t>(t.texel[k]) >= part.texels.size()) {
        throw std::out_of_range("a triangle has a corner that does not exist");
      }
    }
  }
  return part;
}

// Linear light with the gamma of 2 that the renderer uses.
cv::Mat read_texture(const fs::path& file) {
  cv::Mat image;
  try {
    image = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& error) {
    refuse(file, error.err);
  }
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

}  // namespace

std::vector<bool> bones_of_head(const std::vector<MeshBone>& bones) {
  std::vector<bool> of_head;
  of_head.reserve(bones.size());
  for (const MeshBone& bone : bones) {
    of_head.push_back(bone.name == "head" ||
                      (bone.parent >= 0 && of_head[static_cast<std::size_t>(bone.parent)]));
  }
  return of_head;
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
    if (material == materials.end()) {
      throw std::out_of_range("it has no material called body");
    }
    const auto of_body = static_cast<int>(std::distance(materials.begin(), material));
    std::vector<Vector3f> vertices = mesh_files::shaped(folder, look, mesh, read_triangles(mesh, of_body));
    person.bones = mesh_files::read_bones(mesh, vertices);
    body = read_part(mesh, of_body, vertices.size(), person.bones.size());
    body.vertices = std::move(vertices);
    mesh_files::move_knuckles(body, person.bones);
    person.rest_from_face = mesh_files::turn_of_face(person.bones);
  });

  const fs::path skin = data / "skins" / look.skin;
  body.texture = with_file(skin / (look.skin + ".json"), [&](const Json& json) {
    return read_texture(skin / json.at("mapDiffuse").get<std::string>());
  });
  const std::vector<bool> of_head = bones_of_head(person.bones);
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
        Worn{"eyebrows", "eyebrow001", "", Surface::head, true},
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
