// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <string_view>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"

/// Damaged files for the tests of the readers: a seeded fuzzer that does not need clang.
namespace telemime::testing_mutations {

/// The text after a few random changes: bytes replaced, removed or doubled, parts moved, difficult words
/// inserted.
inline std::string mutated(std::string text, Random& random) {
  static constexpr std::string_view kTrouble[] = {"nan",  "-1",   "1e999", "99999999999999999999",
                                                  "null", "{",    "}",     "[[[[",
                                                  "\"",   "\n",   "0",     "-",
                                                  "1e-5", "true", "\xff",  "inf",
                                                  "#",    " "};
  const auto below = [&random](std::size_t bound) {
    return static_cast<std::size_t>(random.below(static_cast<std::uint32_t>(bound)));
  };
  for (std::size_t change = 1 + below(6); change > 0 && !text.empty(); --change) {
    const std::size_t at = below(text.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(text.size() - at, 60));
    switch (below(5)) {
      case 0:
        text[at] = static_cast<char>(below(256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      default:
        text.insert(at, kTrouble[below(std::size(kTrouble))]);
    }
  }
  return text;
}

/// Calls `read` with many kinds of damage to a `valid` text. It must return or throw Error(input), and accept
/// the undamaged text.
inline void expect_robust(const std::string& valid, const std::function<void(std::string_view)>& read) {
  EXPECT_NO_THROW(read(valid));
  const auto survives = [&read](const std::string& text) {
    try {
      read(text);
      return true;
    } catch (const Error& error) {
      return error.kind() == ErrorKind::input && error.what()[0] != '\0';
    }
  };
  for (std::size_t length = 0; length < valid.size(); length += 1 + valid.size() / 400) {
    EXPECT_TRUE(survives(valid.substr(0, length))) << "cut after " << length << " bytes";
  }
  Random random(2026);
  std::size_t refused = 0;
  constexpr std::size_t kRounds = 2000;
  for (std::size_t round = 0; round < kRounds; ++round) {
    const std::string text = mutated(valid, random);
    EXPECT_TRUE(survives(text)) << "round " << round;
    try {
      read(text);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, kRounds / 20);  // else the damage does not reach the reader
  EXPECT_TRUE(survives(std::string(200000, '[')));
  EXPECT_TRUE(survives(std::string(1000, '\0')));
  EXPECT_TRUE(survives("{" + std::string(5000, '\n')));
}

}  // namespace telemime::testing_mutations
