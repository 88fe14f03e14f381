// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/input_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string_view>
#include <system_error>

namespace telemime {
namespace {

constexpr std::string_view file_scheme = "file://";
constexpr std::array<std::string_view, 10> image_extensions = {".png",  ".jpg",  ".jpeg", ".bmp", ".tif",
                                                               ".tiff", ".webp", ".ppm",  ".pgm", ".jp2"};

bool all_digits(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool is_url(const std::string& text) {
  static const std::regex scheme("^[A-Za-z][A-Za-z0-9+.-]+://.*");
  return std::regex_match(text, scheme);
}

bool is_pattern(const std::string& text) {
  static const std::regex number("%0?[0-9]*d");
  return text.find_first_of("*?[") != std::string::npos || std::regex_search(text, number);
}

bool is_port(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Where the host begins, from the position behind "://" on.
std::size_t host_of(const std::string& url, std::size_t start) {
  const std::string_view authority(url.data() + start,
                                   std::min(url.find_first_of("/?#", start), url.size()) - start);
  if (const std::size_t at = authority.rfind('@'); at != std::string_view::npos) {
    return start + at + 1;
  }
  // A password may contain "/", "?" or "#" that should have been encoded; then no port follows the colon.
  const std::size_t colon = authority.find(':');
  if (colon == std::string_view::npos || authority.front() == '[' || is_port(authority.substr(colon + 1))) {
    return start;
  }
  const std::size_t at = url.rfind('@');
  return at == std::string::npos || at < start ? start : at + 1;
}

}  // namespace

std::string name_for_ffmpeg(const std::string& path) {
  return "file:" + path;
}

bool has_image_extension(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(image_extensions.begin(), image_extensions.end(), extension) != image_extensions.end();
}

std::string without_file_scheme(const std::string& input) {
  return input.starts_with(file_scheme) ? input.substr(file_scheme.size()) : input;
}

InputKind input_kind(const std::string& input) {
  if (all_digits(input)) {
    return InputKind::camera;
  }
  if (input.starts_with("/dev/") && !input.starts_with("/dev/shm")) {  // where files may lie
    return InputKind::device;
  }
  const std::string path = without_file_scheme(input);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return InputKind::folder;
  }
  if (!std::filesystem::exists(path, ignored)) {  // files may be named "take[2].mp4" or "a:" / "b.mp4"
    if (is_url(path)) {
      return InputKind::stream;
    }
    if (is_pattern(path)) {
      return InputKind::pattern;
    }
  }
  return has_image_extension(path) ? InputKind::image : InputKind::video_file;
}

std::string in_words(InputKind kind) {
  constexpr std::array<const char*, 7> kWords = {
      "a camera index",           "a camera device", "a stream",    "a folder of images",
      "a pattern of image files", "an image file",   "a video file"};
  return kWords.at(static_cast<std::size_t>(kind));
}

std::string shown_url(const std::string& url) {
  const std::size_t scheme = url.find("://");
  if (scheme == std::string::npos) {
    return url;
  }
  const std::size_t start = scheme + 3;
  const std::size_t host = host_of(url, start);
  std::string place = url.substr(host, std::min(url.find_first_of("?#", host), url.size()) - host);
  if (const std::size_t assignment = place.find('='); assignment != std::string::npos) {
    const std::size_t slash = place.rfind('/', assignment);
    place.erase(slash == std::string::npos ? 0 : slash + 1);
  }
  return url.substr(0, start) + place;
}

Error cannot_read(const std::string& input, InputKind kind, const std::string& cause,
                  const std::string& remedy) {
  return {ErrorKind::input, "cannot read '" + input + "' as " + in_words(kind) + ": " + cause, remedy};
}

void require_readable_file(const std::string& path, InputKind kind) {
  std::error_code problem;
  const std::filesystem::file_status status = std::filesystem::status(path, problem);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw cannot_read(
        path, kind, "no such file",
        "Check the name. An input is a video file, an image, a folder or pattern of images, a stream "
        "URL, or a camera (0, /dev/video0 or a part of its name).");
  }
  if (status.type() == std::filesystem::file_type::none) {
    throw cannot_read(path, kind, problem.message(), "Check the rights of its folders.");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw cannot_read(path, kind, "not a plain file", "Give a video file or a folder of images.");
  }
  errno = 0;
  const std::ifstream file(path, std::ios::binary);
  if (!file) {
    const int reason = errno;
    throw cannot_read(
        path, kind, std::generic_category().message(reason),
        reason == EACCES ? "Give yourself the right to read it: chmod u+r." : "Try a copy of the file.");
  }
  if (std::filesystem::file_size(path, problem) == 0) {
    throw cannot_read(path, kind, "the file is empty", "Record or copy it again.");
  }
}

bool looks_like_text(const std::string& path) {
  constexpr std::string_view raw_video = "YUV4MPEG2";  // its header is text, what follows may look like it
  std::array<char, 1024> start{};
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), start.size());
  const std::string_view bytes(start.data(), static_cast<std::size_t>(file.gcount()));
  return !bytes.starts_with(raw_video) && std::all_of(bytes.begin(), bytes.end(), [](unsigned char c) {
    return c >= 0x20 ? c != 0x7f : c == '\n' || c == '\r' || c == '\t' || c == '\f';
  });
}

}  // namespace telemime
