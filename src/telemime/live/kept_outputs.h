// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "telemime/live/message_level.h"
#include "telemime/live/sender_list.h"

namespace telemime {

/// Keeps the outputs that were added on the page for later runs, in a file (live_settings.h). Nothing is sent
/// to one of an earlier run unless the user asks for it in this one. Of what others wrote into the file,
/// another run at the same time for instance, all stays but what this run was told to forget.
class KeptOutputs {
 public:
  using Tell = std::function<void(MessageLevel, const std::string&)>;

  /// `file` may be empty: nothing is kept, and nothing is known of earlier runs.
  KeptOutputs(std::filesystem::path file, SenderList& senders, Tell tell);

  /// Lists the outputs of earlier runs, off; with `resume` they are sent to. Says which, and what is wrong
  /// with the file or with one of them.
  void offer(bool resume);
  /// From any thread: later runs shall offer it; save() writes it down. Its password is not kept.
  void keep(const std::string& url);
  /// From any thread: later runs shall not offer what means the same.
  void forget(const std::string& url);
  /// Writes into the file what has changed since it was called last. A failure is told, and tried again with
  /// the next change.
  void save();

 private:
  struct Change {
    std::string url;
    bool keep;
  };
  void offer(const std::string& url, bool resume);
  void note(Change change);
  void take_back(std::vector<Change> changes);

  std::filesystem::path file_;
  SenderList& senders_;
  Tell tell_;
  std::mutex mutex_;             ///< of what follows
  std::vector<Change> changes_;  ///< not written yet; one for each URL
  bool due_ = false;             ///< there is one that was not tried yet
};

}  // namespace telemime
