// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/bap_client.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <cmath>
#include <utility>

namespace telemime {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

/// A frame this much too early, as a share of the interval, is taken: times are rounded.
constexpr double kEarly = 0.05;

}  // namespace

BapClient::BapClient(asio::ip::tcp::socket socket, std::function<void(BapClient&, bool)> changed)
    : socket_(std::move(socket)), target_(socket_.get_executor()), changed_(std::move(changed)) {
  error_code ignored;
  socket_.set_option(asio::socket_base::keep_alive(true), ignored);
}

void BapClient::read_on() {
  const auto heard = [self = shared_from_this()](const error_code& error, std::size_t count) {
    const auto act = [&self](BapSession::Command command) {
      self->stop();
      self->changed_(*self, command == BapSession::Command::play && self->play());
    };
    if (error || !self->session_.take({self->incoming_.data(), count}, act)) {
      self->close();
      self->changed_(*self, false);
    } else {
      self->read_on();
    }
  };
  socket_.async_read_some(asio::buffer(incoming_), heard);
}

void BapClient::close() noexcept {
  stop();
  error_code ignored;
  socket_.close(ignored);
}

void BapClient::stop() noexcept {
  error_code ignored;
  target_.close(ignored);
}

// Datagrams go to the client's own address or to a multicast group, and nowhere else: whoever reaches the
// server shall not be able to have it send to others.
bool BapClient::play() {
  const BapWishes& wishes = session_.wishes();
  error_code error;
  asio::ip::address address = socket_.remote_endpoint(error).address();
  if (!error && !wishes.group.empty()) {
    address = asio::ip::make_address(wishes.group, error);
    if (!error && !address.is_multicast()) {
      return false;
    }
  }
  const asio::ip::udp::endpoint endpoint(address, wishes.port);
  if (!error) {
    target_.open(endpoint.protocol(), error);
  }
  if (!error && address.is_multicast()) {
    const asio::ip::address from = socket_.local_endpoint(error).address();
    if (!error && from.is_v4() && address.is_v4()) {
      target_.set_option(asio::ip::multicast::outbound_interface(from.to_v4()), error);
    }
    if (!error) {
      target_.set_option(asio::ip::multicast::hops(wishes.ttl), error);
    }
  }
  if (!error) {
    target_.connect(endpoint, error);
  }
  if (!error) {
    target_.non_blocking(true, error);
  }
  if (error) {
    stop();
    return false;
  }
  first_ = true;
  return true;
}

bool BapClient::send(const std::string& datagram) {
  error_code error;
  target_.send(asio::buffer(datagram), 0, error);
  return !error;
}

bool BapClient::due(double time, double fps) {
  if (!std::isfinite(time)) {
    return false;
  }
  const double interval = 1.0 / (rate() > 0.0 ? std::min(rate(), fps) : fps);
  const bool jumped = time < next_time_ - 2.0 * interval || time > next_time_ + 2.0 * interval;
  if (!first_ && !jumped && time < next_time_ - kEarly * interval) {
    return false;
  }
  next_time_ = first_ || jumped ? time + interval : next_time_ + interval;
  first_ = false;
  return true;
}

}  // namespace telemime
