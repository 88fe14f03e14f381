// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/kept_outputs.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/live/live_settings.h"
#include "telemime/streaming/url.h"

namespace telemime {
namespace {

// The file may hold what this version cannot send to.
std::string meaning_or_text(const std::string& url, SenderKinds kinds) {
  try {
    return meaning_of(url, kinds);
  } catch (const Error&) {
    return url;
  }
}

}  // namespace

KeptOutputs::KeptOutputs(std::filesystem::path file, SenderList& senders, Tell tell)
    : file_(std::move(file)), senders_(senders), tell_(std::move(tell)) {}

void KeptOutputs::offer(bool resume) {
  if (file_.empty()) {
    return;
  }
  try {
    for (const std::string& url : load_settings(file_).outputs) {
      offer(url, resume);
    }
  } catch (const Error& e) {
    tell_(MessageLevel::warning, e.what());
  }
  std::string off;
  for (const SenderStatus& output : senders_.status()) {
    if (output.state == SenderState::off) {
      off += (off.empty() ? "" : ", ") + output.url;
    }
  }
  if (!off.empty()) {
    tell_(MessageLevel::info, "outputs of earlier runs, off now: " + off +
                                  "\n  Switch them on on the page, or start with --resume-outputs.");
  }
}

void KeptOutputs::offer(const std::string& url, bool resume) {
  try {
    senders_.offer(url);
    const std::string shown = without_password(url);
    const std::vector<SenderStatus> outputs = senders_.status();
    const bool off = std::any_of(outputs.begin(), outputs.end(), [&](const SenderStatus& output) {
      return output.url == shown && output.state == SenderState::off;
    });
    if (resume && off) {
      senders_.add(url);
      tell_(MessageLevel::info, "sending again, as in an earlier run: " + shown);
    }
  } catch (const Error& e) {
    tell_(MessageLevel::warning, std::string("an output of an earlier run cannot be used: ") + e.what());
  }
}

void KeptOutputs::keep(const std::string& url) {
  note({without_password(url), true});
}

void KeptOutputs::forget(const std::string& url) {
  note({url, false});
}

void KeptOutputs::note(Change change) {
  if (file_.empty()) {
    return;
  }
  const std::lock_guard lock(mutex_);
  std::erase_if(changes_, [&](const Change& before) { return before.url == change.url; });
  changes_.push_back(std::move(change));
  due_ = true;
}

void KeptOutputs::save() {
  std::vector<Change> changes;
  {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(due_, false)) {
      return;
    }
    changes = std::exchange(changes_, {});
  }
  try {
    update_settings(file_, [&](LiveSettings& settings) {
      for (const Change& change : changes) {
        const std::string meaning = meaning_or_text(change.url, senders_.kinds());
        std::vector<std::string>& urls = settings.outputs;
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
  } catch (const Error& e) {
    take_back(std::move(changes));
    tell_(MessageLevel::warning, e.what());
  } catch (...) {
    take_back(std::move(changes));
    throw;
  }
}

// They are saved with the next change.
void KeptOutputs::take_back(std::vector<Change> changes) {
  const std::lock_guard lock(mutex_);
  for (const Change& newer : changes_) {
    std::erase_if(changes, [&](const Change& before) { return before.url == newer.url; });
  }
  changes_.insert(changes_.begin(), changes.begin(), changes.end());
}

}  // namespace telemime
