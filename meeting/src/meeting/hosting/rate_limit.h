// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>

namespace telemime::meeting {

/// How often one address may try.
struct RateLimitOptions {
  double tries = 120.0;           ///< at once
  double tries_per_second = 2.0;  ///< that come back
  double misses = 20.0;           ///< of them with a wrong link, at once
  double misses_per_second = 0.33;
  std::size_t most_addresses = 4096;  ///< that are remembered
};

/// Counts who tries to come in, by address. Of IPv6 the first 64 bits count: one computer has all of the
/// rest. Time is told, s, and never goes back.
class RateLimit {
 public:
  explicit RateLimit(const RateLimitOptions& rates = {}) : rates_(rates) {}

  /// Whether one more try with a right link is let pass; it is counted then.
  bool allow(const std::string& address, double now);
  /// The same of a wrong one. Apart, so that who guesses shuts nobody out behind the same address: the
  /// secrets are long, and a guess is only a waste of time.
  bool miss(const std::string& address, double now);

 private:
  struct Left {
    double tries;
    double misses;
    double at;
  };
  Left& of(const std::string& address, double now);
  void forget_one();

  RateLimitOptions rates_;
  std::unordered_map<std::string, Left> left_;
};

}  // namespace telemime::meeting
