// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/sender_list.h"

#include <algorithm>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr std::size_t kMost = 16;

}  // namespace

void SenderList::add(const std::string& url) {
  const std::lock_guard lock(mutex_);
  if (std::any_of(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.url == url; })) {
    throw Error(ErrorKind::usage, url + " is sent to already");
  }
  if (entries_.size() >= kMost) {
    throw Error(ErrorKind::usage, "there are " + std::to_string(kMost) + " outputs already",
                "Remove one first.");
  }
  const std::shared_ptr<Sender> sender = make_sender(url);
  if (header_) {
    sender->begin(*header_);
  }
  entries_.push_back({url, sender});
}

bool SenderList::remove(const std::string& url) {
  std::shared_ptr<Sender> gone;  // ends outside the lock: it joins a thread
  const std::lock_guard lock(mutex_);
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.url == url; });
  if (found == entries_.end()) {
    return false;
  }
  gone = std::move(found->sender);
  entries_.erase(found);
  return true;
}

void SenderList::person(const StreamHeader& header) {
  const std::lock_guard lock(mutex_);
  header_ = header;
  for (const Entry& entry : entries_) {
    entry.sender->begin(header);
  }
}

void SenderList::send(const MotionFrame& frame) {
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : entries_) {
    entry.sender->send(frame);
  }
}

std::vector<SenderStatus> SenderList::status() const {
  std::vector<SenderStatus> all;
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : entries_) {
    all.push_back(entry.sender->status());
  }
  return all;
}

}  // namespace telemime
