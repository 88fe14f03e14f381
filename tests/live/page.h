// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "telemime/streaming/testing_web_socket.h"

namespace telemime::live_testing {

using Json = nlohmann::json;

/// The next message of a type for which `wanted` holds; fails the test when there is none in a minute.
template <typename Wanted>
Json hear(SocketClient& page, const std::string& type, const Wanted& wanted) {
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

inline Json hear(SocketClient& page, const std::string& type) {
  return hear(page, type, [](const Json&) { return true; });
}

}  // namespace telemime::live_testing
