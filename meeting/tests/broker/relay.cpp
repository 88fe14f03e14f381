// SPDX-License-Identifier: Apache-2.0
#include "relay.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace telemime::meeting::test_support {
namespace {

using testing_receivers::Fd;

/// Forwards from one end to the other; returns false when it was closed.
bool pass_on(const Fd& from, const Fd& to) {
  if (!from.readable(0)) {
    return true;
  }
  std::array<char, 4096> bytes{};
  const ssize_t size = ::recv(from.get(), bytes.data(), bytes.size(), 0);
  return size > 0 && ::send(to.get(), bytes.data(), static_cast<std::size_t>(size), MSG_NOSIGNAL) == size;
}

}  // namespace

Relay::Relay(std::vector<std::uint16_t> brokers)
    : brokers_(std::move(brokers)), listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
  const int small = 2048;  // so that a stall shows soon
  ::setsockopt(listener_.get(), SOL_SOCKET, SO_RCVBUF, &small, sizeof(small));
  testing_receivers::bind_to(listener_.get(), 0);
  EXPECT_EQ(::listen(listener_.get(), 8), 0);
  thread_ = std::thread([this] { run(); });
}

Relay::~Relay() {
  stop_ = true;
  thread_.join();
}

void Relay::run() {
  while (!stop_) {
    if (listener_.readable(1)) {
      accept();
    }
    const std::lock_guard lock(mutex_);
    for (auto pair = open_.begin(); pair != open_.end();) {
      pair = stalled_ || carry(*pair) ? std::next(pair) : open_.erase(pair);
    }
  }
}

void Relay::accept() {
  Fd sender(::accept(listener_.get(), nullptr, nullptr));
  for (const std::uint16_t port : brokers_) {
    Fd broker(::socket(AF_INET, SOCK_STREAM, 0));
    const sockaddr_in where = testing_receivers::loopback(port);
    if (::connect(broker.get(), reinterpret_cast<const sockaddr*>(&where), sizeof(where)) == 0) {
      const std::lock_guard lock(mutex_);
      open_.push_back({std::move(sender), std::move(broker)});
      ++made_;
      return;
    }
  }
}

bool Relay::carry(const Pair& pair) {
  return pass_on(pair.sender, pair.broker) && pass_on(pair.broker, pair.sender);
}

void Relay::cut_sender() {
  const std::lock_guard lock(mutex_);
  for (Pair& pair : open_) {
    cut_.push_back(std::move(pair.broker));
  }
  open_.clear();
}

void Relay::cut_broker() {
  const std::lock_guard lock(mutex_);
  cut_.clear();
}

}  // namespace telemime::meeting::test_support
