// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/saved_outputs.h"

#include <algorithm>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/live/live_settings.h"
#include "telemime/streaming/url.h"

namespace telemime {
namespace {

// The normalised URL; the URL itself if this version does not support it.
std::string meaning_or_text(const std::string& url, SenderKinds kinds) {
  try {
    return meaning_of(url, kinds);
  } catch (const Error&) {
    return url;
  }
}

}  // namespace

SavedOutputs::SavedOutputs(std::filesystem::path file, SenderList& senders, Report report)
    : file_(std::move(file)), senders_(senders), report_(std::move(report)) {}

void SavedOutputs::offer(bool resume) {
  if (file_.empty()) {
    return;
  }
  try {
    for (const std::string& url : load_settings(file_)) {
      offer(url, resume);
    }
  } catch (const Error& e) {
    report_(MessageLevel::warning, e.what());
  }
  std::string off;
  for (const SenderStatus& output : senders_.status()) {
    if (output.state == SenderState::off) {
      off += (off.empty() ? "" : ", ") + output.url;
    }
  }
  if (!off.empty()) {
    report_(MessageLevel::info, "outputs of earlier runs, off now: " + off +
                                    "\n  Switch them on on the page, or start with --resume-outputs.");
  }
}

void SavedOutputs::offer(const std::string& url, bool resume) {
  try {
    senders_.offer(url);
    const std::string shown = without_password(url);
    const std::vector<SenderStatus> outputs = senders_.status();
    const bool off = std::any_of(outputs.begin(), outputs.end(), [&](const SenderStatus& output) {
      return output.url == shown && output.state == SenderState::off;
    });
    if (resume && off) {
      senders_.add(url);
      report_(MessageLevel::info, "sending again to an output of an earlier run: " + shown);
    }
  } catch (const Error& e) {
    report_(MessageLevel::warning, std::string("an output of an earlier run cannot be used: ") + e.what());
  }
}

void SavedOutputs::keep(const std::string& url) {
  record({without_password(url), true});
}

void SavedOutputs::forget(const std::string& url) {
  record({url, false});
}

void SavedOutputs::record(Change change) {
  if (file_.empty()) {
    return;
  }
  const std::lock_guard lock(mutex_);
  std::erase_if(changes_, [&](const Change& before) { return before.url == change.url; });
  changes_.push_back(std::move(change));
  due_ = true;
}

void SavedOutputs::save() {
  std::vector<Change> changes;
  {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(due_, false)) {
      return;
    }
    changes = std::exchange(changes_, {});
  }
  try {
    update_settings(file_, [&](std::vector<std::string>& urls) {
      for (const Change& change : changes) {
        const std::string meaning = meaning_or_text(change.url, senders_.kinds());
        const auto same = [&](const std::string& url) {
          return meaning_or_text(url, senders_.kinds()) == meaning;
        };
        if (!change.keep) {
          std::erase_if(urls, same);
        } else if (std::none_of(urls.begin(), urls.end(), same)) {
          urls.push_back(change.url);
        }
      }
    });
  } catch (const std::exception& e) {
    restore(std::move(changes));
    report_(MessageLevel::warning, e.what());
  }
}

// Puts the changes back, so that they are written with the next one.
void SavedOutputs::restore(std::vector<Change> changes) {
  const std::lock_guard lock(mutex_);
  for (const Change& newer : changes_) {
    std::erase_if(changes, [&](const Change& before) { return before.url == newer.url; });
  }
  changes_.insert(changes_.begin(), changes.begin(), changes.end());
}

}  // namespace telemime
