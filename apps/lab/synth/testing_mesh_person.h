// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lab/synth/mesh_person.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/core/testing_errors.h"

namespace telemime {

/// Writes a person of a few triangles, in the format of the people that apps/lab/people.sh fetches: a
/// tetrahedron around each bone, a square before the chest as clothes, a triangle each as eyes, brows and
/// hair.
class TinyPeople {
 public:
  explicit TinyPeople(std::filesystem::path folder) : folder_(std::move(folder)) {
    add_bones();
    write_base();
    write_targets();
    const auto at = [&](const char* bone) { return index_of(bone) * kCorners; };
    write_worn("clothes/shirt", "shirt", at("spine04"));
    write_worn("eyes/Low-Poly", "Low-Poly", at("head"));
    write_worn("eyebrows/eyebrow001", "eyebrow001", at("head"));
    write_worn("hair/wig", "wig", at("neck02"));
    write_picture(folder_ / "public/data/proxies/eyes/Low-Poly/textures/brown_eye.png", {20, 40, 60});
    write_picture(folder_ / "public/data/skins/pale/pale.png", {120, 150, 200});
    write_json("public/data/skins/pale/pale.json", {{"mapDiffuse", "pale.png"}});
  }

  /// Of a person of 1.8 m with long arms.
  static MeshLook look() {
    return {.targets = {{"slim", 0.5f}},
            .tall = "tall",
            .stature = 1.8f,
            .upper_arm = 0.31f,
            .forearm = 0.27f,
            .hand = 0.09f,
            .skin = "pale",
            .clothes = "shirt",
            .hair = "wig",
            .eyes = "brown"};
  }

  void write_json(const std::string& name, const nlohmann::json& json) const {
    const std::filesystem::path file = folder_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << json;
  }
  nlohmann::json read_json(const std::string& name) const {
    return nlohmann::json::parse(std::ifstream(folder_ / name));
  }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  using Point = std::array<float, 3>;
  struct Bone {
    std::string name;
    int parent;
    Point head, tail;  // decimetres
  };
  static constexpr std::size_t kCorners = 4;  // vertices of a bone's tetrahedron

  std::size_t index_of(const std::string& name) const {
    for (std::size_t i = 0; i < bones_.size(); ++i) {
      if (bones_[i].name == name) {
        return i;
      }
    }
    return bones_.size();
  }
  void add(const std::string& name, const std::string& parent, const Point& head, const Point& tail) {
    bones_.push_back({name, parent.empty() ? -1 : static_cast<int>(index_of(parent)), head, tail});
  }

  void add_bones() {
    add("root", "", {0, -8, 0}, {0, 0.5f, 0});
    add("spine04", "root", {0, 0.8f, 0}, {0, 5.5f, 0});
    for (const float side : {1.0f, -1.0f}) {
      const std::string end = side > 0.0f ? ".L" : ".R";
      const auto at = [&](float x, float y, float z) { return Point{side * x, y, z}; };
      add("clavicle" + end, "spine04", at(0.2f, 5.6f, 0), at(1, 5.6f, 0));
      add("shoulder01" + end, "clavicle" + end, at(1, 5.6f, 0), at(1.8f, 5.6f, 0));
      add("upperarm01" + end, "shoulder01" + end, at(1.8f, 5.6f, 0), at(3.1f, 4.8f, 0.1f));
      add("upperarm02" + end, "upperarm01" + end, at(3.1f, 4.8f, 0.1f), at(4.2f, 4.0f, 0.2f));
      add("lowerarm01" + end, "upperarm02" + end, at(4.2f, 4.0f, 0.2f), at(5.1f, 3.4f, 0.7f));
      add("lowerarm02" + end, "lowerarm01" + end, at(5.1f, 3.4f, 0.7f), at(6.0f, 2.8f, 1.2f));
      add("wrist" + end, "lowerarm02" + end, at(6.0f, 2.8f, 1.2f), at(6.2f, 2.7f, 1.3f));
      for (int finger = 1; finger <= 5; ++finger) {
        // The thumb points forward, the others are beside each other.
        const float across = 0.25f * static_cast<float>(3 - finger);
        std::string parent = "wrist" + end;
        if (finger > 1) {
          const std::string palm = "metacarpal" + std::to_string(finger - 1) + end;
          add(palm, parent, at(6.2f, 2.7f, 1.3f + across), at(6.8f, 2.2f, 1.3f + across));
          parent = palm;
        }
        const float start = finger == 1 ? 6.3f : 6.8f;
        const float drop = finger == 1 ? 2.7f : 2.2f;
        for (int k = 1; k <= 3; ++k) {
          const std::string name = "finger" + std::to_string(finger) + "-" + std::to_string(k) + end;
          const float from = static_cast<float>(k - 1);
          const float spread = finger == 1 ? 0.3f : 0.0f;
          add(name, parent, at(start + 0.25f * from, drop - 0.2f * from, 1.3f + across + spread * from),
              at(start + 0.25f * (from + 1), drop - 0.2f * (from + 1), 1.3f + across + spread * (from + 1)));
          parent = name;
        }
      }
    }
    add("neck01", "spine04", {0, 6.6f, 0}, {0, 7.1f, 0.1f});
    add("neck02", "neck01", {0, 7.1f, 0.1f}, {0, 7.6f, 0.2f});
    add("head", "neck02", {0, 7.6f, 0.2f}, {0, 9, 0.2f});
    // The face looks down a little.
    add("jaw", "head", {0, 7.7f, 0.9f}, {0, 7.6f, 1.2f});
    add("special03", "head", {0, 8.2f, 1.5f}, {0, 8.3f, 1.8f});
    for (const float side : {1.0f, -1.0f}) {
      const std::string end = side > 0.0f ? ".L" : ".R";
      add("eye" + end, "head", {0.3f * side, 8.7f, 1.3f}, {0.3f * side, 8.7f, 1.5f});
      add("levator05" + end, "head", {0.28f * side, 8.0f, 1.4f}, {0.26f * side, 7.9f, 1.4f});
    }
  }

  // Around each bone: both ends and two points beside it.
  std::vector<Point> corners() const {
    std::vector<Point> points;
    for (const Bone& b : bones_) {
      const Point middle{0.5f * (b.head[0] + b.tail[0]), 0.5f * (b.head[1] + b.tail[1]),
                         0.5f * (b.head[2] + b.tail[2])};
      points.insert(points.end(), {b.head,
                                   b.tail,
                                   {middle[0] + 0.3f, middle[1], middle[2] + 0.3f},
                                   {middle[0] - 0.3f, middle[1], middle[2] + 0.3f}});
    }
    return points;
  }

  void write_base() const {
    nlohmann::json mesh{{"influencesPerVertex", 2},
                        {"uvs", {{0.0, 0.0, 1.0, 0.0, 0.0, 1.0}}},
                        {"materials", {{{"DbgName", "helper"}}, {{"DbgName", "body"}}}},
                        {"bones", nlohmann::json::array()},
                        {"faces", nlohmann::json::array()}};
    for (const Point& p : corners()) {
      for (const float x : p) {
        mesh["vertices"].push_back(x);
      }
    }
    nlohmann::json& places = mesh["metadata"]["joint_pos_idxs"];
    for (std::size_t i = 0; i < bones_.size(); ++i) {
      const Bone& b = bones_[i];
      const std::size_t v = kCorners * i;
      mesh["bones"].push_back(
          {{"name", b.name + "____head"}, {"parent", b.parent < 0 ? -1 : 2 * b.parent + 1}});
      mesh["bones"].push_back({{"name", b.name}, {"parent", 2 * i}});
      places[b.name + "____head"] = {v};
      places[b.name + "____tail"] = {v + 1};
      for (std::size_t k = 0; k < kCorners; ++k) {
        for (const std::size_t bone : {2 * i, std::size_t{0}}) {
          mesh["skinWeights"].push_back(bone > 0 || i == 0 ? 1.0 : 0.0);
          mesh["skinIndices"].push_back(bone);
        }
      }
      // A triangle and, as the other kind of face, a square; then one of a helper.
      for (const auto& face : {std::vector<std::size_t>{10, v, v + 1, v + 2, 1, 0, 1, 2},
                               std::vector<std::size_t>{11, v, v + 2, v + 1, v + 3, 1, 0, 1, 2, 0},
                               std::vector<std::size_t>{10, v, v + 1, v + 3, 0, 0, 1, 2}}) {
        for (const std::size_t number : face) {
          mesh["faces"].push_back(number);
        }
      }
    }
    write_json("public/data/models/human_full_size.json", mesh);
  }

  // Each target moves the vertices by a function of their place.
  void write_targets() const {
    nlohmann::json list;
    std::vector<std::int16_t> numbers;
    const auto target = [&](const std::string& name, const auto& moved) {
      list["targets"]["data/targets/" + name + ".target"] = {name};
      for (const Point& p : corners()) {
        const Point to = moved(p);
        for (std::size_t k = 0; k < 3; ++k) {
          numbers.push_back(static_cast<std::int16_t>(std::lround(1000.0f * (to[k] - p[k]))));
        }
      }
    };
    // In the order of their names. What lies farther out than `from` is carried along by what stretches.
    const auto stretched = [](float side, float from, float to, float by) {
      return [=](const Point& p) {
        const float out = std::clamp((side * p[0] - from) / (to - from), 0.0f, 1.0f);
        return Point{p[0] + side * by * out, p[1], p[2]};
      };
    };
    for (const auto& [name, side] : {std::pair{"l", 1.0f}, std::pair{"r", -1.0f}}) {
      const std::string start = "armslegs/" + std::string(name) + "-";
      target(start + "hand-scale-decr", stretched(side, 6.0f, 6.8f, -0.3f));
      target(start + "hand-scale-incr", stretched(side, 6.0f, 6.8f, 0.3f));
      target(start + "lowerarm-scale-horiz-decr", stretched(side, 4.2f, 6.0f, -0.5f));
      target(start + "lowerarm-scale-horiz-incr", stretched(side, 4.2f, 6.0f, 0.5f));
      target(start + "upperarm-scale-horiz-decr", stretched(side, 1.8f, 4.2f, -0.5f));
      target(start + "upperarm-scale-horiz-incr", stretched(side, 1.8f, 4.2f, 0.5f));
    }
    target("slim", [](const Point& p) { return Point{p[0], p[1], 0.9f * p[2]}; });
    target("tall", [](const Point& p) { return Point{1.2f * p[0], 1.2f * p[1], 1.2f * p[2]}; });
    // The face alone, by 0.2 rad upward.
    target("turned", [](const Point& p) {
      if (p[1] < 7.55f || p[2] < 0.6f) {
        return p;
      }
      const float y = p[1] - 8.0f;
      const float z = p[2] - 1.0f;
      return Point{p[0], 8.0f + std::cos(0.2f) * y + std::sin(0.2f) * z,
                   1.0f - std::sin(0.2f) * y + std::cos(0.2f) * z};
    });
    write_json("src/json/targets/target-list.json", list);
    const std::filesystem::path file = folder_ / "public/data/targets/targets.bin";
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(numbers.data()),
               static_cast<std::streamsize>(numbers.size() * sizeof(numbers[0])));
  }

  // A triangle 2 cm before the vertices of a bone, which it hides.
  void write_worn(const std::string& place, const std::string& name, std::size_t first) const {
    std::vector<int> covered(kCorners * bones_.size(), 0);
    std::fill_n(covered.begin() + static_cast<std::ptrdiff_t>(first), name == "shirt" ? kCorners : 0, 1);
    nlohmann::json mesh{{"influencesPerVertex", 1},
                        {"uvs", {{0.0, 0.0, 1.0, 0.0, 0.0, 1.0}}},
                        {"materials", {{{"mapDiffuse", "cloth.png"}}}},
                        {"faces", {10, 0, 1, 2, 0, 0, 1, 2}},
                        {"metadata", {{"deleteVerts", covered}}}};
    for (std::size_t k = 0; k < 3; ++k) {
      mesh["ref_vIdxs"].push_back({first + k, first, first});
      mesh["weights"].push_back({1.0, 0.0, 0.0});
      mesh["offsets"].push_back({0.0, 0.0, 0.2});
      mesh["skinWeights"].push_back(1.0);
      mesh["skinIndices"].push_back(2 * (first / kCorners));
    }
    write_json("public/data/proxies/" + place + "/" + name + ".json", mesh);
    write_picture(folder_ / "public/data/proxies" / place / "cloth.png", {200, 60, 30});
  }

  static void write_picture(const std::filesystem::path& file, const cv::Scalar& colour) {
    std::filesystem::create_directories(file.parent_path());
    cv::imwrite(file.string(), cv::Mat(4, 4, CV_8UC3, colour));
  }

  std::filesystem::path folder_;
  std::vector<Bone> bones_;
};

/// Tests of that person.
struct MeshPersonTest : ::testing::Test {
  ScratchFolder scratch;
  TinyPeople people{scratch.path()};
  MeshPerson person = read_mesh_person(scratch.path(), TinyPeople::look());

  const MeshBone& bone(const std::string& name) const {
    for (const MeshBone& b : person.bones) {
      if (b.name == name) {
        return b;
      }
    }
    throw std::out_of_range(name);
  }
  std::string refusal() const {
    return testing_errors::message_of(ErrorKind::input,
                                      [&] { read_mesh_person(scratch.path(), TinyPeople::look()); });
  }
};

}  // namespace telemime
