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

/// Stands between a sender and its broker, and can break a connection as networks do.
class Relay {
 public:
  explicit Relay(std::uint16_t broker) : Relay(std::vector{broker}) {}
  /// Leads each connection to the first of these brokers that takes it, as a load balancer does.
  explicit Relay(std::vector<std::uint16_t> brokers);
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;
  ~Relay();

  std::uint16_t port() const { return testing_receivers::port_of(listener_.get()); }
  /// Connections that were made so far.
  int made() const { return made_; }
  /// Breaks what the sender sees. The broker's side stays as it is until cut_broker().
  void cut_sender();
  /// Breaks what the broker sees of all connections that were cut.
  void cut_broker();
  /// From now on nobody reads what the sender writes.
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
