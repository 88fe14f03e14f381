// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace telemime {

/// A glTF 2.0 asset under construction: its JSON and the bytes of its only buffer. No library is used because
/// a recording is patched in place while it grows: its JSON needs a fixed size and a known offset.
struct GltfDocument {
  nlohmann::ordered_json json;
  std::string buffer;
};

/// How a GPU uses the numbers of an accessor (codes of the specification).
enum class GltfTarget { none = 0, vertices = 34962, indices = 34963 };

/// A document with an empty scene.
GltfDocument make_gltf();

/// Appends numbers to the buffer; returns the accessor's index. `type` is SCALAR, VEC3, VEC4 or MAT4.
/// `bounds` adds the minimum and maximum of each component, which positions and key times require.
std::size_t add_accessor(GltfDocument& document, std::span<const float> values, std::string_view type,
                         GltfTarget target = GltfTarget::none, bool bounds = false);
/// Vectors of four small numbers, as they are (`normalised` false) or as fractions of 65535.
std::size_t add_accessor(GltfDocument& document, std::span<const std::uint8_t> values);
std::size_t add_accessor(GltfDocument& document, std::span<const std::uint16_t> values);
/// Indices of triangles.
std::size_t add_indices(GltfDocument& document, std::span<const std::uint32_t> values);

/// Appends to one of the document's lists ("nodes", "meshes", ...); returns the index.
std::size_t add_to(GltfDocument& document, const char* list, nlohmann::ordered_json value);

/// The binary container before the buffer's bytes: its header, the JSON chunk filled with spaces to at least
/// `json_size` bytes, and the head of the binary chunk of `buffer_size` bytes (a multiple of 4). States that
/// size in the JSON. Throws Error(output) above 4 GB.
std::string glb_head(const GltfDocument& document, std::size_t buffer_size, std::size_t json_size = 0);

/// The whole file.
std::string glb_bytes(const GltfDocument& document);

}  // namespace telemime
