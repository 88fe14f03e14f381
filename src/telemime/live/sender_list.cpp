// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/sender_list.h"

#include <algorithm>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/streaming/url.h"

namespace telemime {
namespace {

constexpr std::size_t kMost = 16;

// Nothing for an invalid URL: a page may name a saved output that this version does not support.
std::optional<std::string> meaning_if_any(const std::string& url, SenderKinds kinds) {
  try {
    return meaning_of(url, kinds);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

SenderList::Entry* SenderList::find(const std::string& meaning) {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.meaning == meaning; });
  return found == entries_.end() ? nullptr : &*found;
}

void SenderList::require_space() const {
  if (entries_.size() >= kMost) {
    throw Error(ErrorKind::usage, "there are " + std::to_string(kMost) + " outputs already",
                "Remove one first.");
  }
}

std::string SenderList::url_of_new(const std::string& given, const std::string& meaning) {
  const Entry* const entry = find(meaning);
  if (entry == nullptr) {
    require_space();
    return given;
  }
  const std::string known = without_password(entry->url);
  if (entry->sender) {
    const std::string shown = without_password(given);
    throw Error(ErrorKind::usage,
                shown + " is already in the list" + (known == shown ? "" : ", as " + known));
  }
  return given == known ? entry->url : given;
}

bool SenderList::add(const std::string& given) {
  const std::string meaning = meaning_of(given, kinds_);
  std::string url;
  {
    const std::lock_guard lock(mutex_);
    url = url_of_new(given, meaning);
  }
  // Outside the lock, because it reads files (ca=, key=) and must not delay frames.
  const std::shared_ptr<Sender> sender = make_sender(url, kinds_);
  const std::lock_guard lock(mutex_);
  url_of_new(given, meaning);  // another page may have added it meanwhile
  if (header_) {
    sender->begin(*header_);
  }
  Entry* const entry = find(meaning);
  (entry == nullptr ? entries_.emplace_back() : *entry) = {url, meaning, sender};
  return entry == nullptr;
}

void SenderList::offer(const std::string& url) {
  const std::string meaning = meaning_of(url, kinds_);
  const std::lock_guard lock(mutex_);
  if (find(meaning) == nullptr) {
    require_space();
    entries_.push_back({url, meaning, nullptr});
  }
}

bool SenderList::end(const std::string& url, bool remove) {
  const auto meaning = meaning_if_any(url, kinds_);
  std::shared_ptr<Sender> gone;  // destroyed after the lock is released, because it joins a thread
  const std::lock_guard lock(mutex_);
  Entry* const entry = meaning ? find(*meaning) : nullptr;
  if (entry == nullptr) {
    return false;
  }
  gone = std::move(entry->sender);
  if (remove) {
    entries_.erase(entries_.begin() + (entry - entries_.data()));
  }
  return true;
}

void SenderList::person(const StreamHeader& header) {
  const std::lock_guard lock(mutex_);
  header_ = header;
  for (const Entry& entry : entries_) {
    if (entry.sender) {
      entry.sender->begin(header);
    }
  }
}

void SenderList::send(const MotionFrame& frame, double taken) {
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : entries_) {
    if (entry.sender) {
      entry.sender->send(frame, taken);
    }
  }
}

std::vector<SenderStatus> SenderList::status() const {
  std::vector<SenderStatus> all;
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : entries_) {
    if (entry.sender) {
      all.push_back(entry.sender->status());
    } else {
      SenderStatus& off = all.emplace_back();
      off.url = without_password(entry.url);
      off.state = SenderState::off;
      off.words = "off; nothing is sent";
    }
  }
  return all;
}

}  // namespace telemime
