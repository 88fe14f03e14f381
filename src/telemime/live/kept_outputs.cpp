// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/kept_outputs.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/live/live_settings.h"

namespace telemime {

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
    const std::vector<SenderStatus> outputs = senders_.status();
    const bool off = std::any_of(outputs.begin(), outputs.end(), [&](const SenderStatus& output) {
      return output.url == url && output.state == SenderState::off;
    });
    if (resume && off) {
      senders_.add(url, /*keep=*/true);
      tell_(MessageLevel::info, "sending again, as in an earlier run: " + url);
    }
  } catch (const Error& e) {
    tell_(MessageLevel::warning, std::string("an output of an earlier run cannot be used: ") + e.what());
  }
}

void KeptOutputs::save() {
  if (file_.empty() || !changed_.exchange(false)) {
    return;
  }
  try {
    save_settings(file_, {senders_.kept()});
  } catch (const Error& e) {
    tell_(MessageLevel::warning, e.what());
  }
}

}  // namespace telemime
