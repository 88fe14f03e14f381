// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "lab/synth/mesh_person.h"

/// Reading the files of read_mesh_person(). What is thrown as std::out_of_range becomes an Error(input) with
/// the file's name by with_file().
namespace telemime::mesh_files {

inline constexpr float kUnit = 0.1f;  ///< m; MakeHuman counts in decimetres

/// Throws Error(input) with the file and how to get it again.
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason);

/// The content of a JSON file. Throws Error(input) that names the file.
nlohmann::json read_json(const std::filesystem::path& file);

/// What `read` makes of a file; its Error(input) names the file if a field is missing or of another type.
template <typename Read>
auto with_file(const std::filesystem::path& file, const Read& read) {
  try {
    return read(read_json(file));
  } catch (const nlohmann::json::exception& error) {
    refuse(file, error.what());
  } catch (const std::out_of_range& error) {
    refuse(file, error.what());
  }
}

/// The base mesh in the shape of the look, m. `skin`: its triangles without the helpers. Throws
/// std::out_of_range, or Error(input) for the files of the shapes.
std::vector<Eigen::Vector3f> shaped(const std::filesystem::path& folder, const MeshLook& look,
                                    const nlohmann::json& mesh, const std::vector<MeshPart::Triangle>& skin);

/// The bones of a mesh; vertices and bones in the same unit. Throws std::out_of_range if a bone that a person
/// needs is missing.
std::vector<MeshBone> read_bones(const nlohmann::json& mesh, const std::vector<Eigen::Vector3f>& vertices);

/// Moves the knuckles to where those of people are, and the border between the skin that moves with the palm
/// and that which moves with the finger. In m.
void move_knuckles(MeshPart& body, std::vector<MeshBone>& bones);

/// The turn of the average face that brings its eyes, nose, mouth and chin nearest to those of the person.
Eigen::Matrix3f turn_of_face(const std::vector<MeshBone>& bones);

}  // namespace telemime::mesh_files
