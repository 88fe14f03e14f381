// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/avatar_folder.h"

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/core/text.h"

namespace telemime {
namespace {

constexpr std::string_view kPath = "/avatars/";
constexpr std::string_view kType = ".vrm";
constexpr std::string_view kLight = "-light";
constexpr std::string_view kDefaultLook = "plain";
constexpr std::size_t kLongestName = 32;

// What the web calls a file of this name.
std::string look_of(const std::string& stem) {
  std::string look;
  for (const char c : lower_case(stem)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    if (plain || (!look.empty() && look.back() != '-')) {
      look += plain ? c : '-';
    }
  }
  look.resize(std::min(look.size(), kLongestName));
  while (look.ends_with('-')) {
    look.pop_back();
  }
  return look.empty() ? "avatar" : look;
}

// The VRM files of a folder by their looks. Files whose looks would be the same are numbered, in the order of
// their names.
std::map<std::string, std::filesystem::path> looks_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (lower_case(entry.path().extension().string()) == kType) {
      files.push_back(entry.path());
    }
  }
  if (error) {
    throw Error(ErrorKind::usage, "the avatars in " + folder.string() + " cannot be read: " + error.message(),
                "Choose a folder that contains VRM files.");
  }
  // A file that is called exactly like its look comes before others that would be called so.
  const auto renamed = [](const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    return look_of(stem) != stem;
  };
  std::sort(files.begin(), files.end(), [&](const auto& a, const auto& b) {
    return std::pair(renamed(a), a) < std::pair(renamed(b), b);
  });
  std::map<std::string, std::filesystem::path> looks;
  for (const auto& file : files) {
    const std::string look = look_of(file.stem().string());
    std::string name = look;
    for (int number = 2; looks.contains(name); ++number) {
      const std::string suffix = "-" + std::to_string(number);
      name = look.substr(0, kLongestName - suffix.size()) + suffix;
    }
    looks[name] = file;
  }
  return looks;
}

// The look of which this is the light variant; any other name unchanged.
std::string without_light(const std::string& name) {
  return name.ends_with(kLight) ? name.substr(0, name.size() - kLight.size()) : name;
}

}  // namespace

AvatarFolder::AvatarFolder(const std::filesystem::path& folder, const std::filesystem::path& more) {
  if (!more.empty()) {
    files_ = looks_in(more);
  }
  // A look of `more` hides the whole look of that name, its light variant, too.
  if (!folder.empty()) {
    std::map<std::string, std::filesystem::path> looks = looks_in(folder);
    std::erase_if(looks, [&](const auto& look) { return files_.contains(without_light(look.first)); });
    files_.merge(looks);
  }
  // What only sounds like a light variant ("Traffic Light.vrm") is a look.
  for (const auto& [name, file] : files_) {
    if (!name.ends_with(kLight) || !files_.contains(without_light(name))) {
      looks_.push_back(name);
    }
  }
  std::stable_partition(looks_.begin(), looks_.end(), [](const std::string& l) { return l == kDefaultLook; });
}

std::optional<WebContent> AvatarFolder::file(const std::string& path) const {
  if (!path.starts_with(kPath) || !path.ends_with(kType) || path.size() < kPath.size() + kType.size()) {
    return std::nullopt;
  }
  std::string name = path.substr(kPath.size(), path.size() - kPath.size() - kType.size());
  if (!files_.contains(name)) {
    name = without_light(name);
  }
  const auto found = files_.find(name);
  if (found == files_.end()) {
    return std::nullopt;
  }
  WebContent content;
  content.type = "model/gltf-binary";
  content.file = found->second;
  return content;
}

}  // namespace telemime
