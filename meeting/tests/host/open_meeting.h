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

/// The room r/home/studio on ports of its own.
class OpenMeeting {
 public:
  /// What the usual plan shall be changed in.
  using Change = std::function<void(HostOptions&)>;
  explicit OpenMeeting(const Change& change = {});

  /// Opens it again, as the next run of the program does.
  void open(const Change& change = {});
  void close() { host_.reset(); }
  MeetingHost& host() { return *host_; }
  std::string secrets() const { return folder_.file("state/studio.json"); }
  /// All that was told to the user.
  std::string heard() const;
  std::string speak() const { return invite_of(host_->speak_link()); }
  std::string watch() const { return invite_of(host_->watch_link()); }
  std::string chair() const { return invite_of(host_->chair_link()); }
  static std::string invite_of(const std::string& link) { return link.substr(link.find("#k=") + 3); }

  /// POST /room/enter.
  WebReply ask(const std::string& body,
               const std::string& headers = "Content-Type: application/json\r\n") const;
  /// The answer of one that is let in; fails the test else.
  nlohmann::json enter(const nlohmann::json& question) const;
  /// A newcomer by the link for speaking.
  nlohmann::json newcomer() const;

 private:
  ScratchFolder folder_;
  mutable std::mutex mutex_;
  std::string heard_;
  std::unique_ptr<MeetingHost> host_;
};

/// Says something, retained, and waits for the broker's receipt. False when it does not let the account in.
bool say(std::uint16_t port, const nlohmann::json& account, const std::string& topic,
         const std::string& payload);

}  // namespace telemime::meeting::test_support
