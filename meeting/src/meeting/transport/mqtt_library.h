// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime::meeting {

/// Keeps libmosquitto ready as long as one of these lives. The library counts its users itself, but not
/// safely among threads. It also has the whole process ignore SIGPIPE from its first connection on.
class MqttLibrary {
 public:
  MqttLibrary();
  MqttLibrary(const MqttLibrary&) = delete;
  MqttLibrary& operator=(const MqttLibrary&) = delete;
  ~MqttLibrary();
};

}  // namespace telemime::meeting
