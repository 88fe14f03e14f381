// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "telemime/outputs/bap/profile.h"

/// Reads the BAP files that the encoder writes.
namespace telemime::testing_bap {

struct BapFrame {
  std::size_t mask_length = 0;
  std::int64_t number = 0;
  std::map<int, int> values;  ///< by id
};

struct BapFile {
  std::string version;
  std::string name;
  double fps = 0.0;
  std::int64_t stated_frames = 0;
  std::vector<BapFrame> frames;
};

/// Checks that each frame has a value for each bit of its mask.
inline BapFile parse_bap(const std::string& text) {
  std::istringstream in(text);
  BapFile file;
  in >> file.version >> file.name >> file.fps >> file.stated_frames >> std::ws;
  EXPECT_FALSE(in.fail()) << "the header is not one of a BAP file";
  for (std::string mask, line; std::getline(in, mask) && std::getline(in, line);) {
    BapFrame& frame = file.frames.emplace_back();
    std::istringstream bits(mask);
    std::istringstream values(line);
    values >> frame.number;
    for (int bit = 0; bits >> bit;) {
      ++frame.mask_length;
      if (bit == 1) {
        values >> frame.values[static_cast<int>(frame.mask_length)];
      }
    }
    EXPECT_TRUE(!values.fail() && values.eof()) << "the mask does not fit the values: " << line;
  }
  return file;
}

/// The values of a profile's parameters in this frame; those that the frame does not have keep their `last`.
inline BapValues values_of(const BapProfile& profile, const BapFrame& frame, BapValues last) {
  const auto ids = bap_ids(profile);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto found = frame.values.find(ids[i]);
    last[i] = found == frame.values.end() ? last[i] : found->second;
  }
  return last;
}

}  // namespace telemime::testing_bap
