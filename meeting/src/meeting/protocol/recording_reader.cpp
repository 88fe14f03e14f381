// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/recording_reader.h"

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kPiece = 65536;  // bytes

[[noreturn]] void unusable(const std::filesystem::path& file, const std::string& why,
                           const std::string& remedy = "") {
  throw Error(ErrorKind::input, file.string() + " cannot be used: " + why, remedy);
}

}  // namespace

RecordingReader::RecordingReader(std::filesystem::path file) : file_(std::move(file)) {
  std::error_code error;
  if (std::filesystem::is_directory(file_, error)) {
    unusable(file_, "it is a folder");
  }
  errno = 0;
  in_.open(file_, std::ios::binary);
  if (!in_) {
    unusable(file_, std::generic_category().message(errno));
  }
  start_ = next();
  if (start_) {
    return;
  }
  if (size_ == 0) {
    unusable(file_, "it is empty");
  }
  if (decoder_.fault() == RecordingFault::other_version) {
    unusable(file_, "it is a recording of another version than this program knows",
             "A newer telemime may have made it.");
  }
  if (!decoder_.fault()) {
    unusable(file_, "it breaks off before anything was recorded");
  }
  unusable(file_, "it is no recording of a room", "telemime room record makes one.");
}

std::optional<Record> RecordingReader::next() {
  if (start_) {
    return std::exchange(start_, std::nullopt);
  }
  std::array<char, kPiece> piece{};
  for (;;) {
    if (auto record = decoder_.next()) {
      return record;
    }
    if (decoder_.fault() || in_.eof()) {
      return std::nullopt;
    }
    in_.read(piece.data(), piece.size());
    if (in_.bad()) {
      unusable(file_, "reading it failed");
    }
    const auto count = static_cast<std::size_t>(in_.gcount());
    size_ += count;
    decoder_.feed({reinterpret_cast<const std::uint8_t*>(piece.data()), count});
  }
}

std::string RecordingReader::complaint() const {
  if (decoder_.fault()) {
    return "it is damaged at byte " + std::to_string(decoder_.good()) +
           "; what comes from there on is left out";
  }
  if (size_ != decoder_.good()) {
    return "its end is cut off; " + std::to_string(size_ - decoder_.good()) +
           " bytes that are no whole record are left out";
  }
  return decoder_.ended() ? "" : "the recording was not ended in order; its end may be missing";
}

RecordingReport inspect_recording(const std::filesystem::path& file) {
  RecordingReader reader(file);
  RecordingReport look;
  while (const auto record = reader.next()) {
    look.summary.add(*record);
  }
  look.complaint = reader.complaint();
  return look;
}

}  // namespace telemime::meeting
