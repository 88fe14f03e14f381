// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "telemime/core/errors.h"

namespace telemime {

/// An open file descriptor, or -1; it is closed with this object.
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

/// The whole content of a file. Throws an Error of this kind that names the file and the reason.
std::string read_text_file(const std::filesystem::path& file, ErrorKind kind = ErrorKind::input);

/// A small file that the user named.
struct SmallFile {
  std::string content;
  mode_t mode = 0;  ///< its permissions
  uid_t owner = 0;
};

enum class SymbolicLinks { follow, refuse };

/// Reads a whole file of at most `most` bytes. Refuses pipes, terminals and devices at once, because opening
/// or reading one may block forever. Throws std::system_error, or std::runtime_error with a reason that does
/// not include the file's name.
SmallFile read_small_file(const std::filesystem::path& file, std::size_t most,
                          SymbolicLinks links = SymbolicLinks::follow);

/// Writes to an open file; repeats what was interrupted or incomplete. Returns 0 or the error number: then a
/// part of `content` may have been written.
int write_all(int descriptor, std::string_view content);

/// The Error(output) for a file that cannot be written: the reason is that of the error number.
Error cannot_write(
    const std::filesystem::path& file, int error_number,
    const std::string& remedy = "Choose a folder that you may write to, on a disk with free space.");

/// Replaces a file atomically by way of a temporary file beside it: after an error the old one is unchanged.
/// Throws Error(output).
void write_whole_file(const std::filesystem::path& file, std::string_view content);

/// The same; only its owner may read or write the new file (0600). `durable`: it is on the disk when this
/// returns, and survives a power failure.
void write_private_file(const std::filesystem::path& file, std::string_view content, bool durable = false);

/// Creates the missing folders with permissions for their owner only (0700). Throws Error(output).
void make_private_folders(const std::filesystem::path& folder);

}  // namespace telemime
