// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "telemime/live/live_state.h"
#include "telemime/live/sender_list.h"

namespace telemime {

/// Saves the outputs that the user adds on the page in a file (live_settings.h), for later runs. A saved
/// output is listed but off until the user turns it on. Entries that another program writes into the file are
/// preserved, except those that forget() removes.
class SavedOutputs {
 public:
  using Report = std::function<void(MessageLevel, const std::string&)>;

  /// If `file` is empty, nothing is loaded or saved.
  SavedOutputs(std::filesystem::path file, SenderList& senders, Report report);

  /// Adds the outputs of earlier runs to the list, off, or with `resume` on. Reports them, and reports an
  /// error of the file or of an entry.
  void offer(bool resume);
  /// Marks an output for the next save(), without its password. Thread-safe.
  void keep(const std::string& url);
  /// Removes an output, and all that mean the same, at the next save(). Thread-safe.
  void forget(const std::string& url);
  /// Writes the changes since the last call. A failure is reported; the changes are written with the next
  /// one.
  void save();

 private:
  struct Change {
    std::string url;
    bool keep;
  };
  void offer(const std::string& url, bool resume);
  void record(Change change);
  void restore(std::vector<Change> changes);

  std::filesystem::path file_;
  SenderList& senders_;
  Report report_;
  std::mutex mutex_;             ///< guards the members below
  std::vector<Change> changes_;  ///< not yet written; at most one per URL
  bool due_ = false;             ///< at least one has not been tried
};

}  // namespace telemime
