// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

/// An open file descriptor, or -1.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Throws when a system call failed, unless it was interrupted.
ssize_t checked(ssize_t result) {
  if (result < 0 && errno != EINTR) {
    throw std::system_error(errno, std::generic_category());
  }
  return result < 0 ? 0 : result;
}

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  throw Error(ErrorKind::output,
              path.string() + " cannot be written: " + std::generic_category().message(error));
}

int write_all(int file, const std::string& content) {
  std::size_t written = 0;
  while (written < content.size()) {
    const ssize_t count = ::write(file, content.data() + written, content.size() - written);
    if (count < 0 && errno != EINTR) {
      return errno;
    }
    written += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  return 0;
}

}  // namespace

SmallFile read_small_file(const std::filesystem::path& file, std::size_t most, SymbolicLinks links) {
  const int no_links = links == SymbolicLinks::refuse ? O_NOFOLLOW : 0;
  const Descriptor open(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | no_links));
  checked(open.get());
  struct stat about {};
  checked(::fstat(open.get(), &about));
  if (!S_ISREG(about.st_mode)) {
    throw std::runtime_error("it is not a regular file");
  }
  SmallFile read{std::string(most + 1, '\0'), about.st_mode, about.st_uid};
  std::size_t size = 0;
  for (bool more = true; more && size <= most;) {
    errno = 0;
    const ssize_t count = checked(::read(open.get(), read.content.data() + size, most + 1 - size));
    more = count > 0 || errno == EINTR;
    size += static_cast<std::size_t>(count);
  }
  if (size > most) {
    throw std::runtime_error("it is too long");
  }
  read.content.resize(size);
  return read;
}

void write_private_file(const std::filesystem::path& file, const std::string& content, bool durable) {
  // A new file with mode 0600 replaces the old one by its name.
  std::string other = file.string() + ".XXXXXX";
  const int descriptor = ::mkostemp(other.data(), O_CLOEXEC);
  if (descriptor < 0) {
    fail(file, errno);
  }
  int failure = write_all(descriptor, content);
  if (failure == 0 && durable && ::fsync(descriptor) != 0) {
    failure = errno;
  }
  if (::close(descriptor) != 0 && failure == 0) {
    failure = errno;
  }
  if (failure == 0 && ::rename(other.c_str(), file.c_str()) != 0) {
    failure = errno;
  }
  if (failure != 0) {
    ::unlink(other.c_str());
    fail(file, failure);
  }
  if (durable) {  // the new name, too; some file systems cannot
    const std::filesystem::path folder = file.parent_path();
    const Descriptor open(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    ::fsync(open.get());
  }
}

void make_private_folders(const std::filesystem::path& folder) {
  if (folder.empty() || std::filesystem::is_directory(folder)) {
    return;
  }
  make_private_folders(folder.parent_path());
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
    fail(folder, errno);
  }
}

}  // namespace telemime::meeting
