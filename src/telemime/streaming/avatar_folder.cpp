// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/avatar_folder.h"

#include <algorithm>
#include <string_view>
#include <system_error>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr std::string_view kPath = "/avatars/";
constexpr std::string_view kType = ".vrm";
constexpr std::string_view kLight = "-light";
constexpr std::string_view kDefaultLook = "plain";
constexpr std::size_t kLongestName = 32;

bool is_look_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string_view::npos;
}

}  // namespace

AvatarFolder::AvatarFolder(const std::filesystem::path& folder, const std::filesystem::path& more) {
  for (const auto& place : {folder, more}) {
    std::error_code error;
    for (const auto& entry : place.empty() ? std::filesystem::directory_iterator()
                                           : std::filesystem::directory_iterator(place, error)) {
      const std::string name = entry.path().stem().string();
      if (entry.path().extension() == kType && is_look_name(name)) {
        files_[name] = entry.path();
      }
    }
    if (error) {
      throw Error(ErrorKind::usage,
                  "the avatars in " + place.string() + " cannot be read: " + error.message(),
                  "Choose a folder that contains LOOK.vrm files.");
    }
  }
  for (const auto& [name, file] : files_) {
    if (!name.ends_with(kLight)) {
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
  if (!files_.contains(name) && name.ends_with(kLight)) {
    name.resize(name.size() - kLight.size());
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
