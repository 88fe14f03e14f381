// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "telemime/streaming/web_hub.h"

namespace telemime {

/// Sockets that listen at the address, all at the same port: two for 127.0.0.1 (the second one at ::1, if the
/// system has it). Throws like WebServer.
std::vector<boost::asio::ip::tcp::acceptor> listen_at(boost::asio::io_context& io, const std::string& address,
                                                      std::uint16_t port);

/// Accepts clients, one connection each. It must outlive the run of its io_context.
class WebListener {
 public:
  WebListener(std::shared_ptr<WebHub> hub, boost::asio::ip::tcp::acceptor acceptor);
  void accept();

 private:
  void welcome(boost::asio::ip::tcp::socket socket);

  std::shared_ptr<WebHub> hub_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
};

}  // namespace telemime
