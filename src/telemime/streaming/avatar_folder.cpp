// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/avatar_folder.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

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

AvatarFolder::AvatarFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (folder_.empty()) {
    return;
  }
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() == kType && is_look_name(name)) {
      names_.push_back(name);
    }
  }
  if (error) {
    throw Error(ErrorKind::usage,
                "the avatars in " + folder_.string() + " cannot be read: " + error.message(),
                "Choose a folder that contains LOOK.vrm files.");
  }
  std::sort(names_.begin(), names_.end());
  std::copy_if(names_.begin(), names_.end(), std::back_inserter(looks_),
               [](const std::string& name) { return !name.ends_with(kLight); });
  std::stable_partition(looks_.begin(), looks_.end(), [](const std::string& l) { return l == kDefaultLook; });
}

std::optional<WebContent> AvatarFolder::file(const std::string& path) const {
  if (!path.starts_with(kPath) || !path.ends_with(kType) || path.size() < kPath.size() + kType.size()) {
    return std::nullopt;
  }
  std::string name = path.substr(kPath.size(), path.size() - kPath.size() - kType.size());
  const auto exists = [&] { return std::binary_search(names_.begin(), names_.end(), name); };
  if (!exists() && name.ends_with(kLight)) {
    name.resize(name.size() - kLight.size());
  }
  if (!exists()) {
    return std::nullopt;
  }
  WebContent content;
  content.type = "model/gltf-binary";
  content.file = folder_ / (name + std::string(kType));
  return content;
}

}  // namespace telemime
