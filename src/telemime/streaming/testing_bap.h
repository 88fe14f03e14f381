// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

/// A receiver of BAP text for the tests, from the description of the format alone.
namespace telemime::testing_bap {

/// One frame: the mask has a 0 or 1 for each parameter from 1 on, then come the frame's number and a value
/// for each 1.
struct BapText {
  std::size_t mask_length = 0;
  long number = -1;
  std::map<int, int> values;  ///< by id

  BapText(const std::string& mask, const std::string& rest) {
    std::vector<int> ids;
    for (const std::string& bit : words(mask)) {
      EXPECT_TRUE(bit == "0" || bit == "1") << bit;
      ++mask_length;
      if (bit == "1") {
        ids.push_back(static_cast<int>(mask_length));
      }
    }
    const std::vector<std::string> numbers = words(rest);
    EXPECT_EQ(numbers.size(), ids.size() + 1);
    for (std::size_t i = 0; i < numbers.size() && i <= ids.size(); ++i) {
      if (i == 0) {
        number = std::stol(numbers[0]);
      } else {
        values[ids[i - 1]] = std::stoi(numbers[i]);
      }
    }
  }

  /// A datagram of VREng's server: both on one line, the mask `length` words long.
  static BapText from_datagram(const std::string& datagram, std::size_t length = 186) {
    EXPECT_EQ(datagram.find('\n'), std::string::npos) << "VREng parts words at blanks alone";
    std::string mask;
    std::string rest;
    std::size_t index = 0;
    for (const std::string& word : words(datagram)) {
      (index++ < length ? mask : rest) += word + " ";
    }
    return {mask, rest};
  }

  static std::vector<std::string> words(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> found;
    for (std::string word; stream >> word;) {
      found.push_back(word);
    }
    return found;
  }
};

}  // namespace telemime::testing_bap
