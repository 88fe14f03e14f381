// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/udp_link.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <exception>

#include "telemime/core/errors.h"
#include "telemime/streaming/resolve.h"
#include "telemime/streaming/tcp.h"

namespace telemime {
namespace {

namespace asio = boost::asio;
using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLongestWait{5000};  // for a network that accepts no data
constexpr std::chrono::seconds kLongestSearch{5};        // for a computer's address: Linux asks three times

}  // namespace

UdpLink::UdpLink(SendLoop& loop, const SendUrl& url, std::uint16_t port)
    : loop_(loop), host_(url.host), port_(url.port.value_or(port)), socket_(loop.io()) {}

void UdpLink::open() {
  // IPv4 where the host has it: the avatar programs listen there.
  const asio::ip::udp::endpoint endpoint(asio::ip::make_address(resolve(loop_, host_).front()), port_);
  largest_ = endpoint.address().is_loopback() ? kLargestLocalDatagram : kLargestDatagram;
  frames_ = 0;
  told_ = false;
  believed_at_ = SteadyClock::now() + (unreachable_ ? kLongestSearch : std::chrono::seconds(0));
  boost::system::error_code error;
  socket_.open(endpoint.protocol(), error);
  if (!error) {
    socket_.connect(endpoint, error);  // otherwise the system does not report refusals
  }
  if (error) {
    throw LinkBroken(in_words(error));
  }
  socket_.non_blocking(true);
  tell_of_unreachable(endpoint.protocol() == asio::ip::udp::v4());
  read_on();
  loop_.waiting("waiting for a person to track");
}

void UdpLink::person(const std::shared_ptr<const StreamHeader>& person) {
  if (person_ != person) {
    motion_.emplace(person->body);
    person_ = person;
  }
}

bool UdpLink::frame(const MotionFrame& raw, double /*taken*/) {
  const MotionFrame frame = motion_->clean(raw);
  const auto motion = (*motion_)(frame);
  for (const std::string& datagram : datagrams(motion_->skeleton(), motion ? &*motion : nullptr, frame)) {
    send(datagram);
  }
  // A refusal arrives after the frame that caused it: the next one is sent after it.
  if (++frames_ >= 2 && !told_ && SteadyClock::now() >= believed_at_) {
    loop_.sending();
    told_ = true;
    unreachable_ = false;
  }
  return true;
}

void UdpLink::close() noexcept {
  boost::system::error_code ignored;
  try {
    if (motion_ && socket_.is_open()) {
      for (const std::string& datagram : farewell(motion_->skeleton())) {
        socket_.send(asio::buffer(datagram), 0, ignored);
      }
    }
  } catch (const std::exception&) {  // out of memory: the message is optional
  }
  socket_.close(ignored);
}

/// Otherwise only a refusal is noticed, and frames are sent forever to a computer that is off.
void UdpLink::tell_of_unreachable(bool v4) {
  const int on = 1;
  ::setsockopt(socket_.native_handle(), v4 ? IPPROTO_IP : IPPROTO_IPV6, v4 ? IP_RECVERR : IPV6_RECVERR, &on,
               sizeof on);
}

void UdpLink::send(const std::string& datagram) {
  boost::system::error_code error;
  while (socket_.send(asio::buffer(datagram), 0, error), error == asio::error::would_block) {
    // Nothing is sent at the moment: the receiver's address is being resolved, or a wireless network is
    // slow.
    const auto room = std::make_shared<Completion>();
    socket_.async_wait(asio::socket_base::wait_write, note<>(room));
    if (!loop_.wait([&room] { return room->done; }, kLongestWait)) {
      throw LinkBroken("the network does not accept data for that address");
    }
  }
  if (error && error != asio::error::no_buffer_space) {  // lost, as datagrams may be
    fail(error);
  }
}

void UdpLink::fail(const boost::system::error_code& error) {
  unreachable_ = error == asio::error::host_unreachable;
  throw LinkBroken(in_words(error));
}

/// No data is expected; only refusals matter.
void UdpLink::read_on() {
  socket_.async_receive(asio::buffer(rubbish_),
                        [this](const boost::system::error_code& error, std::size_t /*count*/) {
                          if (error == asio::error::operation_aborted) {
                            return;
                          }
                          if (error && error != asio::error::message_size) {
                            fail(error);
                          }
                          read_on();
                        });
}

void check_no_path(const SendUrl& url, const std::string& example) {
  if (url.path.size() > 1) {
    throw Error(ErrorKind::usage, "the output \"" + url.text + "\" has a path, which is not allowed here",
                "Write it like " + example + ".");
  }
}

}  // namespace telemime
