// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_files.h"

#include <charconv>
#include <string_view>
#include <utility>

#include "telemime/live/page_files.h"

namespace telemime {
namespace {

// "/avatars/robot.vrm": its look.
std::optional<std::string> look_of(std::string_view path) {
  constexpr std::string_view kFolder = "/avatars/";
  constexpr std::string_view kEnding = ".vrm";
  if (!path.starts_with(kFolder) || !path.ends_with(kEnding) ||
      path.size() < kFolder.size() + kEnding.size()) {
    return std::nullopt;
  }
  path.remove_prefix(kFolder.size());
  path.remove_suffix(kEnding.size());
  return std::string(path);
}

std::optional<WebContent> avatar(const std::string& look, AvatarShelf& avatars) {
  if (!AvatarShelf::has(look)) {
    return std::nullopt;
  }
  WebContent content;
  content.type = "model/gltf-binary";
  content.later = [look, &avatars](std::function<void(WebBytes)> ready) {
    avatars.get(look, std::move(ready));
  };
  return content;
}

// "/recordings/3/motion.bvh" in its parts.
std::optional<std::pair<int, std::string>> recorded_name(std::string_view path) {
  constexpr std::string_view kFolder = "/recordings/";
  if (!path.starts_with(kFolder)) {
    return std::nullopt;
  }
  path.remove_prefix(kFolder.size());
  int number = 0;
  const auto [end, failure] = std::from_chars(path.data(), path.data() + path.size(), number);
  if (failure != std::errc() || end == path.data() + path.size() || *end != '/') {
    return std::nullopt;
  }
  return std::pair{number, std::string(end + 1, path.data() + path.size())};
}

}  // namespace

std::optional<WebContent> live_file(const std::string& path, AvatarShelf& avatars, const Recorder& recorder) {
  if (const auto look = look_of(path)) {
    return avatar(*look, avatars);
  }
  if (const auto name = recorded_name(path)) {
    const auto file = recorder.file(name->first, name->second);
    if (!file) {
      return std::nullopt;
    }
    WebContent content;
    content.type = "application/octet-stream";
    content.file_name = "telemime-" + std::to_string(name->first) + "-" + name->second;
    content.file = *file;
    return content;
  }
  return page_file(path);
}

std::optional<WebContent> room_file(const std::string& path, AvatarShelf& avatars) {
  if (const auto look = look_of(path)) {
    return avatar(*look, avatars);
  }
  if (path == "/" || path == "/room") {
    auto page = page_file("/room.html");
    return page ? page : page_file("/");  // built without pages: the note that says so
  }
  return path == "/index.html" ? std::nullopt : page_file(path);
}

}  // namespace telemime
