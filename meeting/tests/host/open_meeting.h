// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "meeting/hosting/host.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/streaming/testing_web.h"

namespace telemime::meeting::test_support {

/// The open meeting r/home/studio on its own ports.
class OpenMeeting {
 public:
  /// Changes the usual options.
  using Change = std::function<void(HostOptions&)>;
  explicit OpenMeeting(const Change& change = {});

  /// Opens it again, like the next run of the program.
  void open(const Change& change = {});
  void close() { host_.reset(); }
  MeetingHost& host() { return *host_; }
  std::string secrets() const { return folder_.file("state/studio.json"); }
  /// All messages for the user.
  std::string reports() const;
  std::string speak() const { return invite_of(host_->speak_link()); }
  std::string watch() const { return invite_of(host_->watch_link()); }
  std::string chair() const { return invite_of(host_->chair_link()); }
  static std::string invite_of(const std::string& link) { return link.substr(link.find("#k=") + 3); }

  /// POST /room/enter.
  WebReply post(const std::string& body,
                const std::string& headers = "Content-Type: application/json\r\n") const;
  /// The answer to a successful login; anything else fails the test.
  nlohmann::json log_in(const nlohmann::json& question) const;
  /// Logs in a new participant by the link to speak.
  nlohmann::json join() const;

 private:
  ScratchFolder folder_;
  mutable std::mutex mutex_;
  std::string reports_;
  std::unique_ptr<MeetingHost> host_;
};

/// Publishes a retained message and waits for the confirmation. Returns false when the broker rejects the
/// account.
bool publish(std::uint16_t port, const nlohmann::json& account, const std::string& topic,
             const std::string& payload);

}  // namespace telemime::meeting::test_support
