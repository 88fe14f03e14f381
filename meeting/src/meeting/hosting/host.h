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

/// The settings of a meeting.
struct HostOptions {
  std::string tenant = "home";  ///< is_topic_segment()
  std::string name = "room";    ///< check_name()
  std::string title = "Telemime";
  int seats = 8;                      ///< chairs at the table, 1 to 100
  std::size_t most = 40;              ///< participants at once, 1 to 500
  double keeps_seat = 300.0;          ///< LoginRules::keeps_seat
  std::filesystem::path secrets;      ///< file of the links (secrets.h)
  bool new_links = false;             ///< replaces the links; earlier ones stop working
  std::string address = "127.0.0.1";  ///< where to listen, numeric IPv4
  std::uint16_t port = 7080;          ///< of the page
  std::string host;                   ///< in links; empty: localhost, or the address
  BrokerOptions broker;               ///< address, certificate and key are those of the page
  std::filesystem::path certificate;  ///< empty: no TLS
  std::filesystem::path key;
  std::vector<std::string> looks;  ///< of the avatars that `file` provides
  /// The file at a path of the page; as WebHandlers::get.
  std::function<std::optional<WebContent>(const std::string& path)> file;
};

/// Throws Error(usage) unless the name of a meeting is 1 to 32 of a-z 0-9 _ -.
void check_name(const std::string& name);

/// A meeting that is open as long as this object exists: a broker, a web server with the page, and logins
/// (meeting/docs/usage.md).
class MeetingHost {
 public:
  /// A warning for the user, from any thread. It contains no secret.
  using Report = std::function<void(const std::string& text)>;

  /// Returns when people can join. Throws Error for options that cannot be used.
  MeetingHost(HostOptions options, Report report);
  MeetingHost(const MeetingHost&) = delete;
  MeetingHost& operator=(const MeetingHost&) = delete;
  ~MeetingHost();  ///< ends everything and leaves only the file of the links

  /// The address of the page, without a secret.
  std::string page() const;
  /// Secret links: anyone who has one can join.
  std::string speak_link() const;
  std::string watch_link() const;
  std::string chair_link() const;
  std::uint16_t port() const;
  std::uint16_t mqtt_port() const;
  std::uint16_t web_port() const;
  pid_t broker() const;  ///< -1 while it is not running

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace telemime::meeting
