// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "telemime/streaming/send_queue.h"

namespace telemime {

/// How an asynchronous operation ended. Shared with its handler, which may run after the wait was given up.
struct Completion {
  bool done = false;
  boost::system::error_code error;
};

/// A handler that notes the end of an operation, for any signature that begins with an error code.
template <class... More>
auto note(const std::shared_ptr<Completion>& completion) {
  return [completion](const boost::system::error_code& error, More...) {
    completion->done = true;
    completion->error = error;
  };
}

/// What an error means to the user: "nobody listens there", "it closed the connection", ...
std::string in_words(const boost::system::error_code& error);

/// Connects `socket` to the first of the host's addresses that takes it, within 5 s each. Small buffers and
/// no delay: what cannot go out now is better dropped. Throws LinkBroken.
void connect_tcp(SendLoop& loop, boost::asio::ip::tcp::socket& socket, const std::string& host,
                 std::uint16_t port);

/// Waits for a write to end. Tells the status when it takes long, throws LinkBroken when it failed or when
/// the receiver has read nothing for 5 s.
void finish_write(SendLoop& loop, const Completion& write);

}  // namespace telemime
