// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/avatar_folder.h"

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

#include "meeting/protocol/room_topic.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr std::string_view kPath = "/avatars/";
constexpr std::string_view kType = ".vrm";
constexpr std::string_view kLight = "-light";

}  // namespace

AvatarFolder::AvatarFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (folder_.empty()) {
    return;
  }
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    const std::string look = entry.path().stem().string();
    if (entry.path().extension() == kType && is_room_segment(look)) {
      looks_.push_back(look);
    }
  }
  if (error) {
    throw Error(ErrorKind::usage,
                "the avatars in " + folder_.string() + " cannot be read: " + error.message(),
                "--avatars names a folder of files LOOK.vrm.");
  }
  std::sort(looks_.begin(), looks_.end());
}

bool AvatarFolder::has(const std::string& look) const {
  return std::binary_search(looks_.begin(), looks_.end(), look);
}

std::optional<WebContent> AvatarFolder::file(const std::string& path) const {
  if (!path.starts_with(kPath) || !path.ends_with(kType) || path.size() < kPath.size() + kType.size()) {
    return std::nullopt;
  }
  std::string look = path.substr(kPath.size(), path.size() - kPath.size() - kType.size());
  if (!has(look) && look.ends_with(kLight)) {
    look.resize(look.size() - kLight.size());
  }
  if (!has(look)) {
    return std::nullopt;
  }
  WebContent content;
  content.type = "model/gltf-binary";
  content.file = folder_ / (look + std::string(kType));
  return content;
}

}  // namespace telemime
