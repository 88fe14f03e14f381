// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "telemime/nets/network.h"

namespace telemime {

/// A network that Telemime can use: the file NAME.tflite.
struct ModelFile {
  std::string_view name;
  std::string_view package_file;  ///< file of the npm packages @mediapipe/... that is or contains the network
  std::size_t bytes = 0;
  std::string_view sha256;  ///< 64 hexadecimal digits
};

/// All networks, sorted by name.
std::span<const ModelFile> model_table();

/// The network of this name. Throws Error(usage) that lists the names if there is none.
const ModelFile& model_named(std::string_view name);

/// The folder of the model files: `folder` if it is not empty, otherwise the first that exists of the
/// environment variable TELEMIME_MODELS, models/ beside the running program (a build) and
/// PREFIX/share/telemime/models (an installation). Empty if none of them exists.
std::filesystem::path find_models(const std::filesystem::path& folder = {});

/// What is missing of these networks, as a sentence with a remedy; empty if nothing is.
std::string missing_models(const std::filesystem::path& folder, std::span<const std::string> names);

/// Reads, checks and prepares a network, or a part of it.
/// Throws Error(config) if the file is missing or is not the one of the table.
Network load_network(const std::filesystem::path& folder, std::string_view name,
                     const NetworkPart& part = {});

}  // namespace telemime
