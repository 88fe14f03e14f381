// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/readers/text_file.h"

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "telemime/core/errors.h"

namespace telemime {

std::string read_text_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw Error(ErrorKind::input, file.string() + " is a folder, not a file", "name the file inside it");
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw Error(ErrorKind::input,
                "cannot read " + file.string() + ": " + std::generic_category().message(errno),
                "check the name and the permissions");
  }
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) {
    throw Error(ErrorKind::input, "reading " + file.string() + " failed half way", "check the disk");
  }
  return text;
}

}  // namespace telemime
