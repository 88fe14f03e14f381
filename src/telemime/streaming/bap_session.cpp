// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/bap_session.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

namespace telemime {
namespace {

constexpr std::size_t kLongestWord = 256;
constexpr double kHighestRate = 1000.0;  // frames a second
constexpr int kHighestTtl = 255;

template <class Number>
std::optional<Number> number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

void set(BapWishes& wishes, char name, std::string_view value) {
  switch (name) {
    case 'a':
      wishes.group = value;
      break;
    case 'p':
      wishes.port = number<std::uint16_t>(value).value_or(wishes.port);
      break;
    case 't':
      wishes.ttl = std::clamp(number<int>(value).value_or(1), 1, kHighestTtl);
      break;
    case 'r': {
      const double rate = number<double>(value).value_or(0.0);
      wishes.rate = rate > 0.0 && rate <= kHighestRate ? rate : 0.0;
      break;
    }
    default:  // the name of a file, and what other versions may know
      break;
  }
}

}  // namespace

/// "play f=hi.bap" and then "stop", with nothing between them: a value that ended with its read.
bool BapSession::next_command_begins(std::string_view bytes) const {
  constexpr std::array<std::string_view, 4> kCommands = {"setup", "play", "stop", "teardown"};
  return word_.size() >= 2 && word_[1] == '=' &&
         std::any_of(kCommands.begin(), kCommands.end(),
                     [bytes](std::string_view command) { return bytes.starts_with(command); });
}

bool BapSession::add(char c) {
  word_ += c;
  return word_.size() <= kLongestWord;
}

BapSession::Word BapSession::end_of_word() {
  const std::string word = std::exchange(word_, {});
  if (word.empty()) {
    return Word::nothing;
  }
  if (word == "setup") {
    wishes_ = {};
    set_up_ = true;
    return Word::nothing;
  }
  if (word.size() >= 2 && word[1] == '=') {
    set(wishes_, word[0], std::string_view(word).substr(2));
    return Word::nothing;
  }
  if (word == "play") {
    return set_up_ ? Word::play : Word::leave;
  }
  return word == "stop" ? Word::stop : Word::leave;
}

}  // namespace telemime
