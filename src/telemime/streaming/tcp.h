// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "telemime/streaming/send_queue.h"

namespace telemime {

/// Result of an asynchronous operation. Shared with its handler, which may run after the wait has timed out.
struct Completion {
  bool done = false;
  boost::system::error_code error;
};

/// A handler that records the end of an operation, for any signature that begins with an error code.
template <class... More>
auto note(const std::shared_ptr<Completion>& completion) {
  return [completion](const boost::system::error_code& error, More...) {
    completion->done = true;
    completion->error = error;
  };
}

/// Describes an error to the user: "no program is listening there", "it closed the connection", ...
std::string in_words(const boost::system::error_code& error);

/// Connects `socket` to the first of the host's addresses that accepts it, within 5 s each. Uses small
/// buffers and no delay, because old frames are better dropped than queued. Throws LinkBroken.
void connect_tcp(SendLoop& loop, boost::asio::ip::tcp::socket& socket, const std::string& host,
                 std::uint16_t port);

/// Waits for a write to end and updates the status if it takes long. Throws LinkBroken if it fails or if the
/// receiver has read nothing for 5 s.
void finish_write(SendLoop& loop, const Completion& write);

}  // namespace telemime
