// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/file_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "telemime/core/files.h"

namespace telemime {
FileOutput::FileOutput(const std::filesystem::path& file, std::unique_ptr<Encoder> encoder,
                       const StreamHeader& header)
    : path_(file), encoder_(std::move(encoder)) {
  const std::string head = encoder_->begin(header);
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    fail(errno);
  }
  seekable_ = ::lseek(descriptor_, 0, SEEK_CUR) >= 0;
  append(head);
}

FileOutput::~FileOutput() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

void FileOutput::write(const MotionFrame& frame) {
  append(encoder_->frame(frame));
  patch();
}

void FileOutput::close() {
  if (descriptor_ < 0) {
    return;
  }
  append(encoder_->end());
  patch();
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0) {
    fail(errno);
  }
}

void FileOutput::append(std::string_view bytes) {
  if (const int error = write_all(descriptor_, bytes); error != 0) {
    fail(error);
  }
  size_ += bytes.size();
}

void FileOutput::patch() {
  const auto patch = encoder_->patch();
  if (!patch || !seekable_) {
    return;
  }
  const ssize_t count =
      ::pwrite(descriptor_, patch->bytes.data(), patch->bytes.size(), static_cast<off_t>(patch->offset));
  if (count != static_cast<ssize_t>(patch->bytes.size())) {
    fail(count < 0 ? errno : EIO);
  }
}

void FileOutput::fail(int error_number) {
  std::string remedy = "choose an existing folder that you may write to, on a disk with free space";
  if (descriptor_ >= 0) {
    // A device, which cannot be truncated, has no frames to keep.
    if (seekable_ && ::ftruncate(descriptor_, static_cast<off_t>(size_)) == 0) {
      remedy += "; what was written before is complete";
    }
    ::close(descriptor_);
    descriptor_ = -1;
  }
  throw cannot_write(path_, error_number, remedy);
}

}  // namespace telemime
