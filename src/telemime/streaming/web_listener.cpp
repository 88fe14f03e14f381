// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_listener.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <chrono>
#include <string_view>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/streaming/web_connection.h"

namespace telemime {
namespace {

namespace ip = boost::asio::ip;
using boost::system::error_code;

ip::tcp::acceptor listen_on(boost::asio::io_context& io, const ip::tcp::endpoint& endpoint,
                            error_code& error) {
  ip::tcp::acceptor acceptor(io);
  acceptor.open(endpoint.protocol(), error);
  if (!error) {
    // A port is free even if its last connections are still closing.
    acceptor.set_option(boost::asio::socket_base::reuse_address(true), error);
  }
  if (!error && endpoint.address().is_v6() && !endpoint.address().is_unspecified()) {
    acceptor.set_option(ip::v6_only(true), error);
  }
  if (!error) {
    acceptor.bind(endpoint, error);
  }
  if (!error) {
    acceptor.listen(boost::asio::socket_base::max_listen_connections, error);
  }
  return acceptor;
}

[[noreturn]] void fail(const std::string& address, std::uint16_t port, const error_code& error) {
  namespace errors = boost::asio::error;
  const std::string number = std::to_string(port);
  if (error == errors::address_in_use) {
    throw Error(ErrorKind::output, "port " + number + " is taken by another program",
                "End that program, or choose another port, for instance --port " +
                    std::to_string(port < 65535 ? port + 1 : port - 1) + " (--port 0 takes a free one).");
  }
  if (error == errors::access_denied) {
    throw Error(ErrorKind::output, "port " + number + " is reserved for the system",
                "Choose a port above 1023, for instance --port 7070.");
  }
  if (error == boost::system::errc::address_not_available) {
    throw Error(ErrorKind::usage, "this computer does not have the address " + address,
                "127.0.0.1 is this computer only, 0.0.0.0 any computer that can reach this one.");
  }
  throw Error(ErrorKind::output,
              "nothing can be served at " + address + ", port " + number + ": " + error.message());
}

ip::address address_of(const std::string& text) {
  error_code error;
  ip::address address = ip::make_address(text == "localhost" ? "127.0.0.1" : text, error);
  if (error) {
    throw Error(ErrorKind::usage, "'" + text + "' is not an address",
                "Write numbers: 127.0.0.1 is for this computer alone, 0.0.0.0 accepts any computer that can "
                "reach this one.");
  }
  return address;
}

}  // namespace

std::vector<ip::tcp::acceptor> listen_at(boost::asio::io_context& io, const std::string& address,
                                         std::uint16_t port) {
  const ip::address first = address_of(address);
  // A port that is free at one of the two addresses may be taken at the other: if any port will do, another
  // is tried.
  for (int tries = port == 0 ? 20 : 1;; --tries) {
    std::vector<ip::tcp::acceptor> acceptors;
    error_code error;
    acceptors.push_back(listen_on(io, {first, port}, error));
    if (error) {
      fail(address, port, error);
    }
    if (first != ip::address_v4::loopback()) {
      return acceptors;
    }
    const std::uint16_t same = acceptors.front().local_endpoint().port();
    ip::tcp::acceptor second = listen_on(io, {ip::address_v6::loopback(), same}, error);
    if (!error) {
      acceptors.push_back(std::move(second));
    }
    if (error != boost::asio::error::address_in_use) {  // other errors: this computer has no IPv6
      return acceptors;
    }
    if (tries <= 1) {
      fail(address, same, error);
    }
  }
}

WebListener::WebListener(std::shared_ptr<WebHub> hub, ip::tcp::acceptor acceptor)
    : hub_(std::move(hub)), acceptor_(std::move(acceptor)), pause_(acceptor_.get_executor()) {}

void WebListener::accept() {
  acceptor_.async_accept([this](error_code error, ip::tcp::socket socket) {
    if (!error) {
      welcome(std::move(socket));
      accept();
      return;
    }
    // If no file descriptor is left for the new connection, retrying at once would use a whole processor.
    pause_.expires_after(std::chrono::milliseconds(100));
    pause_.async_wait([this](error_code cancelled) {
      if (!cancelled) {
        accept();
      }
    });
  });
}

void WebListener::welcome(ip::tcp::socket socket) {
  if (std::shared_ptr<void> ticket = hub_->ticket()) {
    std::make_shared<WebConnection>(hub_, std::move(ticket), std::move(socket))->start();
    return;
  }
  if (hub_->tls()) {
    return;  // text before the handshake would look like a broken server
  }
  constexpr std::string_view full =
      "HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\nContent-Type: text/plain\r\n"
      "Content-Length: 47\r\n\r\nToo many pages are open. Close one, try again.\n";
  error_code ignored;
  socket.non_blocking(true, ignored);
  socket.write_some(boost::asio::buffer(full), ignored);
  socket.shutdown(boost::asio::socket_base::shutdown_both, ignored);
}

}  // namespace telemime
