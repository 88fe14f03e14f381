// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace telemime {

/// What one client of the BAP server has asked for.
struct BapWishes {
  std::string group;          ///< multicast group as it was written; empty: to the client itself
  std::uint16_t port = 4150;  ///< of UDP, where the client listens
  int ttl = 1;                ///< of multicast, 1 to 255
  double rate = 0.0;          ///< frames a second at most; 0: no wish
};

/// The commands of VREng's server "vaps" as they come in: words between white space,
/// `setup [a=group] p=port [t=ttl] r=rate`, `play f=file`, `stop`, `teardown`. VREng ends none of them by a
/// line break, and may send two at once.
class BapSession {
 public:
  enum class Command { play, stop };

  /// The bytes of one read. Calls `act(command)` for each that is complete. False when the client is to be
  /// let go: it said teardown, or nothing that can be understood.
  template <class Act>
  bool take(std::string_view bytes, Act act);

  const BapWishes& wishes() const { return wishes_; }

 private:
  enum class Word { nothing, play, stop, leave };
  bool next_command_begins(std::string_view bytes) const;
  Word end_of_word();
  bool add(char c);

  BapWishes wishes_;
  std::string word_;
  bool set_up_ = false;
};

template <class Act>
bool BapSession::take(std::string_view bytes, Act act) {
  const auto obey = [&](Word word) {
    if (word == Word::play || word == Word::stop) {
      act(word == Word::play ? Command::play : Command::stop);
    }
    return word != Word::leave;
  };
  if (next_command_begins(bytes)) {
    obey(end_of_word());
  }
  for (const char c : bytes) {
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\0') {
      if (!obey(end_of_word())) {
        return false;
      }
    } else if (!add(c)) {
      return false;
    }
  }
  const bool complete = word_ == "stop" || word_ == "play" || word_ == "teardown";
  return !complete || obey(end_of_word());
}

}  // namespace telemime
