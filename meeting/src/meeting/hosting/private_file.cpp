// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/private_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int number) {
  throw Error(ErrorKind::output,
              path.string() + " cannot be written: " + std::generic_category().message(number));
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

// So that the new name lasts, too. Some file systems cannot: then there is nothing to be done.
void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0) {
    ::fsync(descriptor);
    ::close(descriptor);
  }
}

}  // namespace

void write_private_file(const std::filesystem::path& file, const std::string& content, bool lasting) {
  std::string other = file.string() + ".XXXXXX";
  const int descriptor = ::mkostemp(other.data(), O_CLOEXEC);  // new, and 0600
  if (descriptor < 0) {
    fail(file, errno);
  }
  int failure = write_all(descriptor, content);
  if (failure == 0 && lasting && ::fsync(descriptor) != 0) {
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
  if (lasting) {
    sync_folder(file.parent_path());
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
