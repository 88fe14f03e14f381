// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meeting/hosting/hosted_broker.h"
#include "telemime/streaming/web_server.h"

namespace telemime::meeting {

/// A room that is to be opened.
struct HostOptions {
  std::string tenant = "home";  ///< is_topic_segment(), as the name
  std::string name = "room";
  std::string title = "Telemime";
  int seats = 8;                      ///< chairs at the table, 1 to 100
  std::size_t most = 40;              ///< participants at once, 1 to 500
  double keeps_seat = 300.0;          ///< s that an account is kept for who is away while others want one
  std::filesystem::path secrets;      ///< room_secrets.h
  bool new_links = false;             ///< what was shared before opens nothing any more
  std::string address = "127.0.0.1";  ///< where to listen, IPv4 in numbers
  std::uint16_t port = 7080;          ///< of the page
  std::string host;                   ///< in links; empty: localhost, or the address
  BrokerPlace broker;                 ///< address, certificate and key are those of the page
  std::filesystem::path certificate;  ///< empty: no TLS
  std::filesystem::path key;
  std::vector<std::string> looks;  ///< of the avatars that `file` has
  /// What stands at a path of the page; nothing where there is none. As WebHandlers::get.
  std::function<std::optional<WebContent>(const std::string& path)> file;
};

/// Throws Error(usage) unless the name of a meeting is 1 to 32 of a-z 0-9 _ -.
void check_name(const std::string& name);

/// A shared room, open as long as this lives: a broker, the page, and who may come in (docs/rooms.md).
class MeetingHost {
 public:
  enum class Level { info, warning };
  /// Words for the user, from any thread; no secret is in them.
  using Tell = std::function<void(Level, const std::string& words)>;

  /// Returns when people can come in. Throws Error in words for what cannot be used.
  MeetingHost(HostOptions plan, Tell tell);
  MeetingHost(const MeetingHost&) = delete;
  MeetingHost& operator=(const MeetingHost&) = delete;
  ~MeetingHost();  ///< all is ended, and nothing stays behind but the secrets' file

  /// The address of the page, without a secret.
  std::string page() const;
  /// Secret: whoever has it comes in.
  std::string speak_link() const;
  std::string watch_link() const;
  std::string chair_link() const;

  std::uint16_t port() const;
  std::uint16_t mqtt_port() const;
  std::uint16_t web_port() const;
  pid_t broker() const;  ///< -1 while there is none

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace telemime::meeting
