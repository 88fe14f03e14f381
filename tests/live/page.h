// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
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

}  // namespace telemime::live_testing
