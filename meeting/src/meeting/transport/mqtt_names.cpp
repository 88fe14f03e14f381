// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/mqtt_names.h"

#include <random>
#include <string_view>

namespace telemime::meeting {

std::uint16_t any_session() {
  std::random_device chance;
  return static_cast<std::uint16_t>(std::uniform_int_distribution<int>(1, UINT16_MAX)(chance));
}

std::string any_client_id(const std::string& who) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  constexpr int kCount = 8;
  std::random_device chance;
  std::string id = who + "-";
  for (int i = 0; i < kCount; ++i) {
    id += kDigits[chance() % kDigits.size()];
  }
  return id;
}

}  // namespace telemime::meeting
