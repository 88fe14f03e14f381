// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/files.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

namespace telemime {
namespace {

namespace fs = std::filesystem;

/// Throws when a system call failed, unless it was interrupted.
ssize_t checked(ssize_t result) {
  if (result < 0 && errno != EINTR) {
    throw std::system_error(errno, std::generic_category());
  }
  return result < 0 ? 0 : result;
}

/// Writes a new file and gives it the name of the old one. `descriptor` is the new file's.
void replace(const fs::path& file, const std::string& new_file, int descriptor, std::string_view content,
             bool durable) {
  if (descriptor < 0) {
    throw cannot_write(file, errno);
  }
  int failure = write_all(descriptor, content);
  if (failure == 0 && durable && ::fsync(descriptor) != 0) {
    failure = errno;
  }
  if (::close(descriptor) != 0 && failure == 0) {
    failure = errno;
  }
  if (failure == 0 && ::rename(new_file.c_str(), file.c_str()) != 0) {
    failure = errno;
  }
  if (failure != 0) {
    ::unlink(new_file.c_str());
    throw cannot_write(file, failure);
  }
}

}  // namespace

std::string read_text_file(const fs::path& file, ErrorKind kind) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) {
    throw Error(kind, file.string() + " is a folder, not a file", "name the file inside it");
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw Error(kind, "cannot read " + file.string() + ": " + std::generic_category().message(errno),
                "check the name and the permissions");
  }
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) {
    throw Error(kind, "reading " + file.string() + " failed half way", "check the disk");
  }
  return text;
}

SmallFile read_small_file(const fs::path& file, std::size_t most, SymbolicLinks links) {
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
    throw std::runtime_error("it is too long: more than " + std::to_string(most) + " bytes");
  }
  read.content.resize(size);
  return read;
}

int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t count = ::write(descriptor, content.data(), content.size());
    if (count < 0 && errno != EINTR) {
      return errno;
    }
    content.remove_prefix(count > 0 ? static_cast<std::size_t>(count) : 0);
  }
  return 0;
}

Error cannot_write(const fs::path& file, int error_number, const std::string& remedy) {
  return {ErrorKind::output,
          "cannot write " + file.string() + ": " + std::generic_category().message(error_number), remedy};
}

void write_whole_file(const fs::path& file, std::string_view content) {
  const std::string new_file = file.string() + ".new";
  const int descriptor = ::open(new_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  replace(file, new_file, descriptor, content, /*durable=*/false);
}

void write_private_file(const fs::path& file, std::string_view content, bool durable) {
  std::string new_file = file.string() + ".XXXXXX";
  const int descriptor = ::mkostemp(new_file.data(), O_CLOEXEC);  // mode 0600
  replace(file, new_file, descriptor, content, durable);
  if (durable) {  // the new name, too; some file systems cannot
    const fs::path folder = file.parent_path();
    const Descriptor open(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    ::fsync(open.get());
  }
}

void make_private_folders(const fs::path& folder) {
  std::error_code hidden;  // below a folder that this user may not enter: mkdir says so
  if (folder.empty() || fs::is_directory(folder, hidden)) {
    return;
  }
  make_private_folders(folder.parent_path());
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
    throw cannot_write(folder, errno);
  }
}

}  // namespace telemime
