// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <functional>
#include <memory>
#include <string>

#include "telemime/streaming/bap_session.h"

namespace telemime {

/// One client of the BAP server: its TCP connection, what it asked for, and where its datagrams go.
class BapClient : public std::enable_shared_from_this<BapClient> {
 public:
  /// `changed` is called when it has asked to play (again), with true, and when it has stopped or has gone.
  BapClient(boost::asio::ip::tcp::socket socket, std::function<void(BapClient&, bool plays)> changed);

  /// Reads commands until the connection ends.
  void read_on();
  bool connected() const { return socket_.is_open(); }
  bool playing() const { return target_.is_open(); }
  double rate() const { return session_.wishes().rate; }
  void close() noexcept;

  /// Sends a datagram; false when it could not go.
  bool send(const std::string& datagram);
  /// Whether a frame of this time (s) is due at `fps`.
  bool due(double time, double fps);

 private:
  bool play();
  void stop() noexcept;

  boost::asio::ip::tcp::socket socket_;
  boost::asio::ip::udp::socket target_;
  std::function<void(BapClient&, bool)> changed_;
  BapSession session_;
  double next_time_ = 0.0;  ///< s: the frame after the last one is due then
  bool first_ = true;       ///< no frame since it asked to play
  std::array<char, 512> incoming_{};
};

}  // namespace telemime
