// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/gltf/document.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <vector>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

static_assert(std::endian::native == std::endian::little,
              "glTF is little-endian, as is what is copied into it");

constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr std::size_t kAlignment = 4;

std::size_t aligned(std::size_t size) {
  return (size + kAlignment - 1) / kAlignment * kAlignment;
}

std::size_t components(std::string_view type) {
  if (type == "SCALAR") {
    return 1;
  }
  return type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
}

template <class Number>
std::size_t add(GltfDocument& document, std::span<const Number> values, int component, std::string_view type,
                GltfTarget target) {
  const std::size_t offset = document.buffer.size();
  document.buffer.resize(aligned(offset + values.size_bytes()), '\0');
  std::memcpy(document.buffer.data() + offset, values.data(), values.size_bytes());
  nlohmann::ordered_json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size_bytes()}};
  if (target != GltfTarget::none) {
    view["target"] = static_cast<int>(target);
  }
  const std::size_t index = add_to(document, "bufferViews", std::move(view));
  return add_to(document, "accessors",
                {{"bufferView", index},
                 {"componentType", component},
                 {"count", values.size() / components(type)},
                 {"type", type}});
}

void append_number(std::string& bytes, std::size_t number) {
  const auto value = static_cast<std::uint32_t>(number);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace

GltfDocument make_gltf() {
  GltfDocument document;
  document.json["asset"] = {{"version", "2.0"}, {"generator", "Telemime"}};
  document.json["scene"] = 0;
  document.json["scenes"] = {{{"nodes", nlohmann::ordered_json::array()}}};
  return document;
}

std::size_t add_accessor(GltfDocument& document, std::span<const float> values, std::string_view type,
                         GltfTarget target, bool bounds) {
  const std::size_t index = add(document, values, kFloat, type, target);
  if (bounds && !values.empty()) {
    const std::size_t width = components(type);
    std::vector<float> low(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width));
    std::vector<float> high = low;
    for (std::size_t i = 0; i < values.size(); ++i) {
      low[i % width] = std::min(low[i % width], values[i]);
      high[i % width] = std::max(high[i % width], values[i]);
    }
    document.json["accessors"][index]["min"] = low;
    document.json["accessors"][index]["max"] = high;
  }
  return index;
}

std::size_t add_accessor(GltfDocument& document, std::span<const std::uint8_t> values) {
  return add(document, values, kUnsignedByte, "VEC4", GltfTarget::vertices);
}

std::size_t add_accessor(GltfDocument& document, std::span<const std::uint16_t> values) {
  const std::size_t index = add(document, values, kUnsignedShort, "VEC4", GltfTarget::vertices);
  document.json["accessors"][index]["normalized"] = true;
  return index;
}

std::size_t add_indices(GltfDocument& document, std::span<const std::uint32_t> values) {
  // 65535 itself is excluded: it restarts strips.
  if (std::all_of(values.begin(), values.end(), [](std::uint32_t v) { return v < 65535; })) {
    const std::vector<std::uint16_t> narrow(values.begin(), values.end());
    return add(document, std::span<const std::uint16_t>(narrow), kUnsignedShort, "SCALAR",
               GltfTarget::indices);
  }
  return add(document, values, kUnsignedInt, "SCALAR", GltfTarget::indices);
}

std::size_t add_to(GltfDocument& document, const char* list, nlohmann::ordered_json value) {
  auto& array = document.json[list];
  array.push_back(std::move(value));
  return array.size() - 1;
}

std::string glb_head(const GltfDocument& document, std::size_t buffer_size, std::size_t json_size) {
  nlohmann::ordered_json json = document.json;
  json["buffers"] = {{{"byteLength", buffer_size}}};
  std::string text = json.dump();
  text.resize(aligned(std::max(text.size(), json_size)), ' ');
  constexpr std::size_t kHeads = 12 + 8 + 8;
  const std::size_t total = kHeads + text.size() + buffer_size;
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorKind::output, "a GLB file cannot hold more than 4 GB",
                "Record a shorter time, or write bvh or jsonl.");
  }
  std::string bytes = "glTF";
  append_number(bytes, 2);
  append_number(bytes, total);
  append_number(bytes, text.size());
  bytes += "JSON" + text;
  append_number(bytes, buffer_size);
  bytes.append("BIN\0", 4);
  return bytes;
}

std::string glb_bytes(const GltfDocument& document) {
  return glb_head(document, document.buffer.size()) + document.buffer;
}

}  // namespace telemime
