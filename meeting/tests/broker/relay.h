// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <mutex>
#include <thread>
#include <vector>

#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting::test_support {

/// Forwards between a sender and its broker, and can break connections as networks do.
class Relay {
 public:
  explicit Relay(std::uint16_t broker) : Relay(std::vector{broker}) {}
  /// Forwards each connection to the first of these brokers that accepts it, like a load balancer.
  explicit Relay(std::vector<std::uint16_t> brokers);
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;
  ~Relay();

  std::uint16_t port() const { return testing_receivers::port_of(listener_.get()); }
  /// Number of connections so far.
  int made() const { return made_; }
  /// Breaks the sender's side. The broker's side stays open until cut_broker().
  void cut_sender();
  /// Breaks the broker's side of all connections that were cut.
  void cut_broker();
  /// From now on does not read what the sender writes.
  void stall() { stalled_ = true; }

 private:
  struct Pair {
    testing_receivers::Fd sender;
    testing_receivers::Fd broker;
  };
  void run();
  void accept();
  static bool carry(const Pair& pair);

  const std::vector<std::uint16_t> brokers_;
  testing_receivers::Fd listener_;
  std::mutex mutex_;
  std::list<Pair> open_;
  std::vector<testing_receivers::Fd> cut_;  ///< brokers' sides
  std::atomic<int> made_ = 0;
  std::atomic<bool> stalled_ = false;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace telemime::meeting::test_support
