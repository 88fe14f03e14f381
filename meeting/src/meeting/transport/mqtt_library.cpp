// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/mqtt_library.h"

#include <mosquitto.h>

#include <mutex>

namespace telemime::meeting {
namespace {

// The library's count has no lock of its own, and it is one for the whole process: so must this be.
std::mutex& count_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

MqttLibrary::MqttLibrary() {
  const std::lock_guard lock(count_mutex());
  mosquitto_lib_init();
}

MqttLibrary::~MqttLibrary() {
  const std::lock_guard lock(count_mutex());
  mosquitto_lib_cleanup();
}

}  // namespace telemime::meeting
