// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/file_check.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

namespace telemime {

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
        "URL, or a camera (0, /dev/video0).");
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
