// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/models/table.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/core/installed.h"
#include "telemime/core/text.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

constexpr ModelFile kModels[] = {
#include "telemime/nets/models/table.inc"
};

constexpr const char* kRemedy =
    "The models are installed with the program: build it where npm is (scripts/deps.sh build page), or set "
    "TELEMIME_MODELS to their folder.";

std::string hexadecimal_sha256(std::span<const std::byte> bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw Error(ErrorKind::config, "OpenSSL cannot compute SHA-256");
  }
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    text += kDigits[digest[i] >> 4U];
    text += kDigits[digest[i] & 15U];
  }
  return text;
}

fs::path file_of(const fs::path& folder, std::string_view name) {
  return folder / (std::string(name) + ".tflite");
}

}  // namespace

std::span<const ModelFile> model_table() {
  return kModels;
}

const ModelFile& model_named(std::string_view name) {
  const auto found = std::find_if(std::begin(kModels), std::end(kModels),
                                  [&](const auto& model) { return model.name == name; });
  if (found == std::end(kModels)) {
    throw Error(ErrorKind::usage, "there is no network " + std::string(name),
                "Choose one of " + joined(kModels, &ModelFile::name) + ".");
  }
  return *found;
}

fs::path find_models(const fs::path& folder) {
  if (!folder.empty()) {
    return folder;
  }
  std::vector<fs::path> places;
  if (const char* const named = std::getenv("TELEMIME_MODELS"); named != nullptr) {
    places.emplace_back(named);
  }
  std::error_code failed;
  places.push_back(code_folder() / "models");
  if (const fs::path installed = installed_folder(code_folder(), "models"); !installed.empty()) {
    places.push_back(installed / "models");
  }
  // A program of somebody else, built with the library of the packages, lies anywhere.
  places.emplace_back("/usr/local/share/telemime/models");
  places.emplace_back("/usr/share/telemime/models");
  const auto found = std::find_if(places.begin(), places.end(),
                                  [&](const fs::path& place) { return fs::is_directory(place, failed); });
  return found == places.end() ? fs::path() : *found;
}

std::string missing_models(const fs::path& folder, std::span<const std::string> names) {
  if (folder.empty()) {
    return std::string("the folder of the models was not found\n  ") + kRemedy;
  }
  std::vector<std::string> missing;
  for (const std::string& name : names) {
    std::error_code failed;
    if (!fs::is_regular_file(file_of(folder, name), failed)) {
      missing.push_back(name + ".tflite");
    }
  }
  return missing.empty() ? std::string()
                         : "there is no " + joined(missing) + " in " + folder.string() + "\n  " + kRemedy;
}

Network load_network(const fs::path& folder, std::string_view name, const NetworkPart& part) {
  const ModelFile& model = model_named(name);
  const std::array<std::string, 1> names = {std::string(name)};
  if (const std::string missing = missing_models(folder, names); !missing.empty()) {
    throw Error(ErrorKind::config, missing);
  }
  const fs::path path = file_of(folder, name);
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes(model.bytes);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  const bool complete = file.good() && file.peek() == std::ifstream::traits_type::eof();
  if (!complete || hexadecimal_sha256(std::as_bytes(std::span(bytes))) != model.sha256) {
    throw Error(ErrorKind::config, "the model " + path.string() + " is damaged or of another version",
                kRemedy);
  }
  return Network(std::as_bytes(std::span(bytes)), part);
}

}  // namespace telemime
