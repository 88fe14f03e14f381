// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace telemime::meeting {
namespace {

[[noreturn]] void refuse(int error) {
  throw std::runtime_error(std::generic_category().message(error));
}

/// A file that is open for reading.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {
    if (descriptor_ < 0) {
      refuse(errno);
    }
  }
  ~OpenFile() { ::close(descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace

SmallFile read_small_file(const std::filesystem::path& file, std::size_t most) {
  const OpenFile open(file);
  struct stat about {};
  if (::fstat(open.get(), &about) != 0) {
    refuse(errno);
  }
  if (!S_ISREG(about.st_mode)) {
    throw std::runtime_error("it is no file");
  }
  SmallFile read{std::string(most + 1, '\0'), about.st_mode};
  std::size_t size = 0;
  while (size <= most) {
    const ssize_t count = ::read(open.get(), read.content.data() + size, most + 1 - size);
    if (count == 0) {
      break;
    }
    if (count < 0 && errno != EINTR) {
      refuse(errno);
    }
    size += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  if (size > most) {
    throw std::runtime_error("it is too long");
  }
  read.content.resize(size);
  return read;
}

}  // namespace telemime::meeting
