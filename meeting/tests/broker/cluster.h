// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "telemime/core/scratch_folder.h"

namespace telemime::meeting::test_support {

/// Three real nodes of nats-server for the meeting home/studio, configured by scripts/cluster.py, on loopback
/// ports. They end with the test.
class Cluster {
 public:
  static constexpr std::size_t kNodes = 3;

  /// All nodes run and accept clients.
  Cluster();
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;
  ~Cluster();

  /// The MQTT port of a node (0 to 2).
  std::uint16_t port(std::size_t node) const { return ports_.at(node); }
  /// The password of an account: "p01", "watch", "service". Its user is "studio.p01".
  std::string password(const std::string& account) const;
  /// "mqtt://studio.p01:password@127.0.0.1:port/home/studio"
  std::string url(std::uint16_t port, const std::string& account) const;
  /// Kills a node: its connections break.
  void kill(std::size_t node);
  /// Starts it again at the same ports, with its data, and waits until it accepts clients.
  void start(std::size_t node);
  /// The output of a node.
  std::string log(std::size_t node) const;

 private:
  bool try_start_all();
  void launch(std::size_t node);
  bool has_ended(std::size_t node);
  bool accepts_clients(std::size_t node) const;
  bool comes_up(std::size_t node);
  std::string file(const std::string& name) const;

  ScratchFolder folder_;
  int attempt_ = 0;
  std::array<std::uint16_t, kNodes> ports_{};
  std::array<pid_t, kNodes> processes_{-1, -1, -1};
};

}  // namespace telemime::meeting::test_support
