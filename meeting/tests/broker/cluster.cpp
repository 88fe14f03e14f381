// SPDX-License-Identifier: Apache-2.0
#include "cluster.h"

#include <gtest/gtest.h>
#include <mosquitto.h>
#include <sys/wait.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "broker.h"
#include "meeting/protocol/testing.h"

namespace telemime::meeting::test_support {
namespace {

using std::chrono::steady_clock;

constexpr int kAttempts = 5;
constexpr std::chrono::seconds kPatience{60};  // until a node accepts clients: the nodes elect a leader first
constexpr int kOneAnswer = 100;                // ms

std::uint16_t port_in(const std::string& url) {
  return static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
}

}  // namespace

// Another program may take a port first: then try others.
Cluster::Cluster() {
  while (attempt_ < kAttempts) {
    ++attempt_;
    run({TELEMIME_PYTHON, TELEMIME_SOURCE_DIR "/scripts/cluster.py", "make", file(""), "--loopback"});
    if (try_start_all()) {
      return;
    }
    for (std::size_t node = 0; node < kNodes; ++node) {
      kill(node);
    }
  }
  ADD_FAILURE() << "no cluster could be started: " << log(0) << log(1) << log(2);
}

Cluster::~Cluster() {
  for (std::size_t node = 0; node < kNodes; ++node) {
    kill(node);
  }
}

std::string Cluster::file(const std::string& name) const {
  return folder_.file("cluster" + std::to_string(attempt_) + "/" + name);
}

bool Cluster::try_start_all() {
  const auto written = nlohmann::json::parse(content_of(file("cluster.json")));
  for (std::size_t node = 0; node < kNodes; ++node) {
    ports_.at(node) = port_in(written.at("nodes").at(node).at("mqtt"));
    launch(node);
  }
  return comes_up(0) && comes_up(1) && comes_up(2);
}

void Cluster::launch(std::size_t node) {
  const std::string name = "node" + std::to_string(node + 1) + ".conf";
  processes_.at(node) = start_program({TELEMIME_NATS_SERVER, "-c", file(name)}, file(name + ".log"));
}

bool Cluster::has_ended(std::size_t node) {
  if (::waitpid(processes_.at(node), nullptr, WNOHANG) == 0) {
    return false;
  }
  processes_.at(node) = -1;
  return true;
}

/// Whether the node accepts an account now; without a leader it answers late.
bool Cluster::accepts_clients(std::size_t node) const {
  std::optional<int> answer;
  const std::unique_ptr<mosquitto, void (*)(mosquitto*)> client(mosquitto_new(nullptr, true, &answer),
                                                                mosquitto_destroy);
  mosquitto_connect_callback_set(client.get(), [](mosquitto* /*client*/, void* self, int code) {
    *static_cast<std::optional<int>*>(self) = code;
  });
  mosquitto_username_pw_set(client.get(), "studio.watch", password("watch").c_str());
  int result = mosquitto_connect(client.get(), "127.0.0.1", port(node), 60);
  const auto end = steady_clock::now() + std::chrono::seconds(5);
  while (result == MOSQ_ERR_SUCCESS && !answer && steady_clock::now() < end) {
    result = mosquitto_loop(client.get(), kOneAnswer, 1);
  }
  mosquitto_disconnect(client.get());
  return answer == 0;
}

bool Cluster::comes_up(std::size_t node) {
  mosquitto_lib_init();
  const auto end = steady_clock::now() + kPatience;
  bool up = false;
  while (!up && !has_ended(node) && steady_clock::now() < end) {
    up = accepts_clients(node);
    if (!up) {
      std::this_thread::sleep_for(std::chrono::milliseconds(kOneAnswer));
    }
  }
  mosquitto_lib_cleanup();
  return up;
}

void Cluster::kill(std::size_t node) {
  kill_process(processes_.at(node));
}

void Cluster::start(std::size_t node) {
  launch(node);
  EXPECT_TRUE(comes_up(node)) << log(node);
}

std::string Cluster::password(const std::string& account) const {
  return nlohmann::json::parse(content_of(file("keys/" + account + ".json"))).at("password");
}

std::string Cluster::url(std::uint16_t port, const std::string& account) const {
  return "mqtt://studio." + account + ":" + password(account) + "@127.0.0.1:" + std::to_string(port) +
         "/home/studio";
}

std::string Cluster::log(std::size_t node) const {
  return content_of(file("node" + std::to_string(node + 1) + ".conf.log"));
}

}  // namespace telemime::meeting::test_support
