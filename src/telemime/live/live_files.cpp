// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_files.h"

#include <charconv>
#include <memory>
#include <utility>

#include "telemime/streaming/web_path.h"

namespace telemime {
namespace {

constexpr std::string_view kAvatarPage = "/avatar.html";

// Number and file name in "/recordings/3/motion.bvh".
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

bool has_hash(std::string_view path) {
  constexpr std::size_t hash_length = 8;
  constexpr std::string_view folder = "/assets/";
  const std::string_view name = path.substr(path.rfind('/') + 1);
  const std::string_view stem = name.substr(0, name.rfind('.'));
  return path.starts_with(folder) && stem.size() > hash_length + 1 && stem.size() < name.size() &&
         stem[stem.size() - hash_length - 1] == '-';
}

std::optional<WebContent> page_file(std::string_view path) {
  const std::string_view wanted = path == "/" ? "/index.html" : path == "/avatar" ? kAvatarPage : path;
  for (const PageFile& file : page_table()) {
    if (file.path == wanted) {
      WebContent content{std::make_shared<const std::string>(file.bytes), web_type(wanted), "",
                         has_hash(wanted)};
      content.connects = wanted == kAvatarPage ? "http: https:" : "";  // the avatar may be anywhere
      return content;
    }
  }
  return std::nullopt;
}

std::optional<WebContent> live_file(const std::string& path, const AvatarFolder& avatars,
                                    const Recorder& recorder) {
  if (auto avatar = avatars.file(path)) {
    return avatar;
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
  auto page = page_file(path);
  return page || path != "/avatar" ? page : page_file("/");  // built without pages: the note that says so
}

std::optional<WebContent> room_file(const std::string& path, const AvatarFolder& avatars) {
  if (auto avatar = avatars.file(path)) {
    return avatar;
  }
  if (path == "/" || path == "/room") {
    auto page = page_file("/meeting.html");
    return page ? page : page_file("/");  // built without pages: the note that says so
  }
  return path == "/index.html" || path.starts_with("/avatar") ? std::nullopt : page_file(path);
}

}  // namespace telemime
