// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "telemime/streaming/testing_web_socket.h"

namespace telemime::live_testing {

using Json = nlohmann::json;

/// The next message of this type for which `wanted` holds. Fails the test if there is none within a minute.
template <typename Wanted>
Json receive(SocketClient& page, const std::string& type, const Wanted& wanted) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < deadline) {
    const auto message = page.message();
    if (!message) {
      break;
    }
    if (message->opcode == SocketClient::text) {
      Json json = Json::parse(message->payload);
      if (json.at("type") == type && wanted(json)) {
        return json;
      }
    }
  }
  ADD_FAILURE() << "no such " << type;
  return {};
}

inline Json receive(SocketClient& page, const std::string& type) {
  return receive(page, type, [](const Json&) { return true; });
}

/// The words of the next message about an error.
inline std::string receive_error(SocketClient& page) {
  return receive(page, "message", [](const Json& j) { return j.at("level") == "error"; })
      .at("words")
      .get<std::string>();
}

/// A page at a port where a program is about to listen; null when it never does.
inline std::unique_ptr<SocketClient> connect_when_ready(std::uint16_t port) {
  std::unique_ptr<SocketClient> page;
  comes_true([&] {
    try {
      page = std::make_unique<SocketClient>(port);
    } catch (const std::runtime_error&) {
      return false;
    }
    return true;
  });
  return page;
}

}  // namespace telemime::live_testing
