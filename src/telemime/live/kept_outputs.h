// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "telemime/live/message_level.h"
#include "telemime/live/sender_list.h"

namespace telemime {

/// Keeps the outputs that were added on the page for later runs, in a file (live_settings.h). Nothing is sent
/// to one of an earlier run unless the user asks for it in this one.
class KeptOutputs {
 public:
  using Tell = std::function<void(MessageLevel, const std::string&)>;

  /// `file` may be empty: nothing is kept, and nothing is known of earlier runs.
  KeptOutputs(std::filesystem::path file, SenderList& senders, Tell tell);

  /// Lists the outputs of earlier runs, off; with `resume` they are sent to. Says which, and what is wrong
  /// with the file or with one of them.
  void offer(bool resume);
  /// From any thread: SenderList::kept() may have changed.
  void changed() { changed_ = true; }
  /// Writes the file when something has changed; a failure is told.
  void save();

 private:
  void offer(const std::string& url, bool resume);

  std::filesystem::path file_;
  SenderList& senders_;
  Tell tell_;
  std::atomic<bool> changed_ = false;
};

}  // namespace telemime
