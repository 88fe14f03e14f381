// SPDX-License-Identifier: Apache-2.0
#include "avatars/avatar.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "avatars/skinning.h"
#include "avatars/tailor.h"
#include "telemime/core/errors.h"
#include "telemime/core/text.h"
#include "telemime/outputs/gltf/humanoid.h"

namespace telemime {
namespace {

using Json = nlohmann::ordered_json;

Shape symmetric(Shape shape) {
  const auto even = [&](Segment l, Segment r) {
    const SegmentScale a = shape[l];
    const SegmentScale b = shape[r];
    shape[l] =
        shape[r] = {0.5 * (a.length + b.length), 0.5 * (a.height + b.height), 0.5 * (a.width + b.width)};
  };
  even(Segment::l_upper_arm, Segment::r_upper_arm);
  even(Segment::l_forearm, Segment::r_forearm);
  even(Segment::l_hand, Segment::r_hand);
  return shape;
}

// Outside these the surfaces would not fit their grids, or be nothing.
void check(const Shape& shape) {
  const auto between = [](double value, double low, double high) { return value >= low && value <= high; };
  bool good = between(shape.stature, 0.5, 2.5);
  for (const SegmentScale& scale : shape.segments) {
    for (const double value : {scale.length, scale.height, scale.width}) {
      good = good && between(value, 0.4, 2.5);
    }
  }
  if (!good) {
    throw Error(ErrorKind::usage, "no avatar can be made with these proportions",
                "Give a height between 0.5 and 2.5 m, and scales between 0.4 and 2.5.");
  }
}

// sRGB to linear light (IEC 61966-2-1), rounded so that the file is short.
std::vector<double> linear(Colour colour) {
  std::vector<double> rgb;
  for (const unsigned shift : {16U, 8U, 0U}) {
    const double v = static_cast<double>((colour >> shift) & 0xFFU) / 255.0;
    const double light = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    rgb.push_back(std::round(light * 1e4) / 1e4);
  }
  return rgb;
}

std::vector<float> flat(const std::vector<Eigen::Vector3d>& points) {
  std::vector<float> numbers;
  numbers.reserve(3 * points.size());
  for (const Eigen::Vector3d& p : points) {
    for (const double value : p) {
      numbers.push_back(static_cast<float>(value));
    }
  }
  return numbers;
}

std::vector<float> flat_units(const std::vector<Eigen::Vector3d>& directions) {
  std::vector<float> numbers;
  for (const Eigen::Vector3d& d : directions) {
    const Eigen::Vector3f unit = d.cast<float>().normalized();
    numbers.insert(numbers.end(), unit.begin(), unit.end());
  }
  return numbers;
}

// Weights as whole numbers of 1/65535 that sum to exactly 1.
std::array<std::uint16_t, 4> whole(const SkinWeights& weights) {
  constexpr int kOne = 65535;
  std::array<std::uint16_t, 4> result{};
  int rest = kOne;
  for (std::size_t i = 1; i < 4; ++i) {
    result[i] = static_cast<std::uint16_t>(std::lround(weights.weight[i] * kOne));
    rest -= result[i];
  }
  result[0] = static_cast<std::uint16_t>(rest);
  return result;
}

std::size_t add_material(GltfDocument& document, const AvatarPart& part) {
  std::vector<double> colour = linear(part.colour);
  Json material = {{"name", part.name}};
  if (part.glows) {
    material["emissiveFactor"] = colour;
  }
  colour.push_back(1.0);
  material["pbrMetallicRoughness"] = {
      {"baseColorFactor", colour}, {"metallicFactor", 0.0}, {"roughnessFactor", part.roughness}};
  return add_to(document, "materials", std::move(material));
}

Json primitive(GltfDocument& document, const Figure& figure, const AvatarPart& part, bool on_head) {
  std::vector<std::uint8_t> bones;
  std::vector<std::uint16_t> weights;
  std::vector<std::uint32_t> indices;
  for (const Eigen::Vector3d& p : part.surface.vertices) {
    SkinWeights skin = on_head ? rigid(HumanBone::head) : skin_weights(figure, p);
    const auto amount = whole(skin);
    for (std::size_t i = 0; i < 4; ++i) {
      bones.push_back(amount[i] > 0 ? skin.bone[i] : std::uint8_t{0});
      weights.push_back(amount[i]);
    }
  }
  for (const auto& t : part.surface.triangles) {
    indices.insert(indices.end(), t.begin(), t.end());
  }
  Json result;
  result["attributes"] = {
      {"POSITION", add_accessor(document, flat(part.surface.vertices), "VEC3", GltfTarget::vertices, true)},
      {"NORMAL", add_accessor(document, flat_units(part.surface.normals), "VEC3", GltfTarget::vertices)},
      {"JOINTS_0", add_accessor(document, bones)},
      {"WEIGHTS_0", add_accessor(document, weights)}};
  result["indices"] = add_indices(document, indices);
  result["material"] = add_material(document, part);
  // The shapes that leave a part where it is share one array of zeros.
  std::optional<std::size_t> still;
  for (const std::vector<Eigen::Vector3d>& moved : part.moved) {
    if (moved.empty()) {
      continue;
    }
    const bool moves = std::any_of(moved.begin(), moved.end(), [](const auto& m) { return m.norm() > 0.0; });
    if (moves || !still) {
      const std::size_t index = add_accessor(document, flat(moved), "VEC3", GltfTarget::vertices, true);
      still = moves ? still : index;
      result["targets"].push_back({{"POSITION", index}});
    } else {
      result["targets"].push_back({{"POSITION", *still}});
    }
  }
  return result;
}

Json expression(std::size_t node, const std::vector<int>& targets) {
  Json binds = Json::array();
  for (const int target : targets) {
    binds.push_back({{"node", node}, {"index", target}, {"weight", 1.0}});
  }
  return {{"morphTargetBinds", binds},
          {"overrideBlink", "none"},
          {"overrideLookAt", "none"},
          {"overrideMouth", "none"}};
}

// Each shape, and blink: both eyes.
Json expressions(std::size_t face) {
  Json preset = {{"blink", expression(face, {0, 1})}};
  for (std::size_t shape = 0; shape < kFaceShapeCount; ++shape) {
    preset[std::string(kFaceShapeNames[shape])] = expression(face, {static_cast<int>(shape)});
  }
  return {{"preset", preset}};
}

// The eyes are drawn on the head: expressions move them.
Json look_at(const Figure& figure) {
  const Json range = {{"inputMaxValue", 30.0}, {"outputScale", 1.0}};
  return {{"offsetFromHeadBone", {0.0, 0.036 * figure.head_size(), 0.1 * figure.head_size()}},
          {"type", "expression"},
          {"rangeMapHorizontalInner", range},
          {"rangeMapHorizontalOuter", range},
          {"rangeMapVerticalDown", range},
          {"rangeMapVerticalUp", range}};
}

Json meta(const AvatarLook& look) {
  return {{"name", "Telemime " + std::string(look.name)},
          {"version", "1"},
          {"authors", {"Telemime contributors"}},
          {"copyrightInformation", "Telemime contributors"},
          {"licenseUrl", "https://vrm.dev/licenses/1.0/"},
          {"otherLicenseUrl", "https://www.apache.org/licenses/LICENSE-2.0"},
          {"avatarPermission", "everyone"},
          {"allowExcessivelyViolentUsage", true},
          {"allowExcessivelySexualUsage", true},
          {"commercialUsage", "corporation"},
          {"allowPoliticalOrReligiousUsage", true},
          {"allowAntisocialOrHateUsage", false},
          {"creditNotation", "unnecessary"},
          {"allowRedistribution", true},
          {"modification", "allowModificationRedistribution"}};
}

}  // namespace

const AvatarLook& avatar_look(std::string_view name) {
  const auto found = std::find_if(kAvatarLooks.begin(), kAvatarLooks.end(),
                                  [&](const AvatarLook& look) { return look.name == name; });
  if (found == kAvatarLooks.end()) {
    throw Error(ErrorKind::usage, "there is no look called \"" + std::string(name) + "\"",
                "Choose one of: " + joined(kAvatarLooks, &AvatarLook::name) + ".");
  }
  return *found;
}

std::string make_avatar(const Shape& shape, const AvatarLook& look) {
  check(shape);
  const Figure figure = make_figure(make_body(symmetric(shape)));
  GltfDocument document = make_gltf();
  add_humanoid(document, figure.skeleton);
  const std::size_t skin = add_humanoid_skin(document, figure.skeleton);

  Json body = Json::array();
  for (const AvatarPart& part : make_outfit(figure, look)) {
    body.push_back(primitive(document, figure, part, false));
  }
  for (const AvatarPart& part : make_hair(figure, look)) {
    body.push_back(primitive(document, figure, part, true));
  }
  Json face = Json::array();
  for (const AvatarPart& part : make_face(figure, look)) {
    face.push_back(primitive(document, figure, part, true));
  }
  const std::size_t body_mesh =
      add_to(document, "meshes", {{"name", "body"}, {"primitives", std::move(body)}});
  const std::size_t face_mesh = add_to(document, "meshes",
                                       {{"name", "face"},
                                        {"primitives", std::move(face)},
                                        {"weights", std::vector<double>(kFaceShapeCount, 0.0)},
                                        {"extras", {{"targetNames", kFaceShapeNames}}}});
  add_skinned_mesh(document, "body", body_mesh, skin);
  const std::size_t face_node = add_skinned_mesh(document, "face", face_mesh, skin);

  document.json["extensionsUsed"] = {"VRMC_vrm"};
  document.json["extensions"]["VRMC_vrm"] = {{"specVersion", "1.0"},
                                             {"meta", meta(look)},
                                             {"humanoid", {{"humanBones", human_bones(figure.skeleton)}}},
                                             {"lookAt", look_at(figure)},
                                             {"expressions", expressions(face_node)}};
  return glb_bytes(document);
}

}  // namespace telemime
