// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/tcp.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>

#include "telemime/streaming/resolve.h"

namespace telemime {
namespace {

namespace asio = boost::asio;
using std::chrono::milliseconds;

constexpr milliseconds kLongestConnect{5000};
constexpr milliseconds kSlowWrite{1000};
constexpr milliseconds kLongestWrite{4000};  // after that
constexpr int kSendBuffer = 16 * 1024;       // bytes: about a second of BAP frames

void connect(SendLoop& loop, asio::ip::tcp::socket& socket, const asio::ip::tcp::endpoint& endpoint) {
  boost::system::error_code ignored;
  socket.close(ignored);
  socket.open(endpoint.protocol());
  socket.set_option(asio::socket_base::send_buffer_size(kSendBuffer));
  socket.set_option(asio::ip::tcp::no_delay(true));
  socket.set_option(asio::socket_base::keep_alive(true));
  const auto connected = std::make_shared<Completion>();
  socket.async_connect(endpoint, note<>(connected));
  if (!loop.wait([&] { return connected->done; }, kLongestConnect)) {
    throw LinkBroken("it does not respond");
  }
  if (connected->error) {
    throw LinkBroken(in_words(connected->error));
  }
}

}  // namespace

std::string in_words(const boost::system::error_code& error) {
  namespace e = boost::asio::error;
  if (error == e::connection_refused) {
    return "no program is listening there";
  }
  if (error == e::connection_reset || error == e::broken_pipe || error == e::eof ||
      error == e::connection_aborted) {
    return "it closed the connection";
  }
  if (error == e::host_unreachable || error == e::network_unreachable || error == e::network_down) {
    return "that computer cannot be reached from here";
  }
  if (error == e::timed_out) {
    return "it does not respond";
  }
  if (error == e::address_in_use) {
    return "another program uses that port";
  }
  if (error == e::access_denied) {
    return "the system does not allow it";
  }
  return error.message();
}

void connect_tcp(SendLoop& loop, asio::ip::tcp::socket& socket, const std::string& host, std::uint16_t port) {
  std::string cause;
  for (const std::string& address : resolve(loop, host)) {
    try {
      connect(loop, socket, {asio::ip::make_address(address), port});
      return;
    } catch (const std::exception& e) {  // most receivers listen at the first address
      cause = cause.empty() ? e.what() : cause;
    }
  }
  throw LinkBroken(cause);
}

void finish_write(SendLoop& loop, const Completion& write) {
  const auto done = [&write] { return write.done; };
  if (!loop.wait(done, kSlowWrite)) {
    loop.sending("it reads too slowly; frames are dropped");
    if (!loop.wait(done, kLongestWrite)) {
      throw LinkBroken("it does not read the data");
    }
    loop.sending();
  }
  if (write.error) {
    throw LinkBroken(in_words(write.error));
  }
}

}  // namespace telemime
