// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// A small reader of binary glTF for the tests, written from the specification. Not installed.
namespace telemime::testing_glb {

struct Glb {
  nlohmann::json json;
  std::string buffer;
};

inline std::uint32_t number_at(const std::string& bytes, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

/// Checks the container as it goes.
inline Glb parse(const std::string& bytes) {
  Glb glb;
  if (bytes.size() < 28 || bytes.substr(0, 4) != "glTF") {
    ADD_FAILURE() << "not a GLB file";
    return glb;
  }
  EXPECT_EQ(number_at(bytes, 4), 2U);
  EXPECT_EQ(number_at(bytes, 8), bytes.size());
  const std::size_t json_size = number_at(bytes, 12);
  EXPECT_EQ(json_size % 4, 0U);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  glb.json = nlohmann::json::parse(bytes.substr(20, json_size));
  const std::size_t buffer_size = number_at(bytes, 20 + json_size);
  EXPECT_EQ(buffer_size % 4, 0U);
  EXPECT_EQ(bytes.substr(24 + json_size, 4), std::string("BIN\0", 4));
  glb.buffer = bytes.substr(28 + json_size);
  EXPECT_EQ(glb.buffer.size(), buffer_size);
  EXPECT_EQ(glb.json["buffers"][0]["byteLength"], buffer_size);
  return glb;
}

inline std::size_t width_of(const std::string& type) {
  return type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
}

/// All numbers of an accessor of this type of number; they must lie inside its part of the buffer.
template <class Number>
std::vector<Number> numbers(const Glb& glb, std::size_t accessor) {
  const auto& a = glb.json["accessors"][accessor];
  const auto& view = glb.json["bufferViews"][a["bufferView"].get<std::size_t>()];
  const int component = a["componentType"];
  EXPECT_EQ(sizeof(Number), component == 5121 ? 1U : component == 5123 ? 2U : 4U);
  std::vector<Number> values(a["count"].get<std::size_t>() * width_of(a["type"]));
  const std::size_t size = values.size() * sizeof(Number);
  const std::size_t offset = view["byteOffset"];
  EXPECT_EQ(view["byteLength"], size);
  EXPECT_EQ(offset % 4, 0U);
  if (offset + size > glb.buffer.size()) {
    ADD_FAILURE() << "accessor " << accessor << " is past the end of the buffer";
    return {};
  }
  std::memcpy(values.data(), glb.buffer.data() + offset, size);
  return values;
}

/// A node's own transform at a moment.
struct Local {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// All nodes at this time (s) of the first animation, as a player shows them: linear, and the nearest key
/// outside.
inline std::vector<Local> play(const Glb& glb, double time) {
  std::vector<Local> nodes;
  for (const auto& node : glb.json["nodes"]) {
    Local local;
    if (node.contains("translation")) {
      const std::vector<double> t = node["translation"];
      local.translation = Eigen::Vector3d(t[0], t[1], t[2]);
    }
    nodes.push_back(local);
  }
  for (const auto& channel : glb.json["animations"][0]["channels"]) {
    const auto& sampler = glb.json["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
    EXPECT_EQ(sampler["interpolation"], "LINEAR");
    const auto times = numbers<float>(glb, sampler["input"]);
    const auto values = numbers<float>(glb, sampler["output"]);
    const auto after = std::lower_bound(times.begin(), times.end(), static_cast<float>(time));
    const std::size_t b =
        after == times.end() ? times.size() - 1 : static_cast<std::size_t>(after - times.begin());
    const std::size_t a = after == times.end() || b == 0 ? b : b - 1;
    const double share = a == b ? 0.0 : (time - times[a]) / (static_cast<double>(times[b]) - times[a]);
    Local& node = nodes[channel["target"]["node"].get<std::size_t>()];
    const auto vector = [&](std::size_t key) {
      return Eigen::Vector3d(values[3 * key], values[3 * key + 1], values[3 * key + 2]);
    };
    const auto quaternion = [&](std::size_t key) {
      return Eigen::Quaterniond(values[4 * key + 3], values[4 * key], values[4 * key + 1],
                                values[4 * key + 2]);
    };
    if (channel["target"]["path"] == "translation") {
      node.translation = (1.0 - share) * vector(a) + share * vector(b);
    } else {
      node.rotation = quaternion(a).slerp(share, quaternion(b));
    }
  }
  return nodes;
}

/// The index of a node by its name.
inline std::size_t node_named(const Glb& glb, const std::string& name) {
  const auto& nodes = glb.json["nodes"];
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i]["name"] == name) {
      return i;
    }
  }
  ADD_FAILURE() << "no node " << name;
  return 0;
}

/// Where a node is: the transforms from the root of its tree down to it.
inline Eigen::Vector3d place_of(const Glb& glb, const std::vector<Local>& nodes, std::size_t node) {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (std::size_t i = node;;) {
    place = nodes[i].rotation * place + nodes[i].translation;
    std::size_t parent = nodes.size();
    for (std::size_t p = 0; p < nodes.size(); ++p) {
      const auto children = glb.json["nodes"][p].value("children", std::vector<std::size_t>());
      if (std::find(children.begin(), children.end(), i) != children.end()) {
        parent = p;
      }
    }
    if (parent == nodes.size()) {
      return place;
    }
    i = parent;
  }
}

}  // namespace telemime::testing_glb
