// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "meeting/protocol/pose_frame.h"
#include "meeting/protocol/recording_reader.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {

/// The message of the Error that the call throws, which must be of that kind; "" if it throws nothing.
template <class Call>
std::string error_of(const Call& call, std::optional<ErrorKind> kind = std::nullopt) {
  try {
    call();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), kind.value_or(e.kind()));
    return e.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Decodes a pose frame that must be valid.
inline PoseFrame frame_of(const std::string& bytes) {
  const auto frame = decode_pose_frame({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  EXPECT_TRUE(frame) << bytes.size() << " bytes";
  return frame ? *frame : PoseFrame();
}

inline std::string bytes_of(const PoseFrame& frame) {
  const auto bytes = encode(frame);
  return {bytes.begin(), bytes.end()};
}

/// All records of a recording.
inline std::vector<Record> records_of(const std::string& file) {
  RecordingReader reader(file);
  std::vector<Record> records;
  while (auto record = reader.next()) {
    records.push_back(std::move(*record));
  }
  return records;
}

}  // namespace telemime::meeting
