// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/input_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
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

}  // namespace

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
  if (input.starts_with("/dev/")) {
    return InputKind::device;
  }
  const std::string path = without_file_scheme(input);
  if (is_url(path)) {
    return InputKind::stream;
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return InputKind::folder;
  }
  // A file may be named "take[2].mp4": an existing file is not a pattern.
  if (!std::filesystem::exists(path, ignored) && is_pattern(path)) {
    return InputKind::pattern;
  }
  return has_image_extension(path) ? InputKind::image : InputKind::video_file;
}

std::string in_words(InputKind kind) {
  switch (kind) {
    case InputKind::camera:
      return "a camera index";
    case InputKind::device:
      return "a camera device";
    case InputKind::stream:
      return "a stream";
    case InputKind::folder:
      return "a folder of images";
    case InputKind::pattern:
      return "a pattern of image files";
    case InputKind::image:
      return "an image file";
    case InputKind::video_file:
      break;
  }
  return "a video file";
}

}  // namespace telemime
