// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/avatar_shelf.h"

#include <exception>
#include <utility>

#include "avatars/avatar.h"

namespace telemime {
namespace {

constexpr std::string_view kLight = "-light";

AvatarLook look_at(std::size_t place) {
  return place < kAvatarLooks.size() ? kAvatarLooks[place] : light(kAvatarLooks[place - kAvatarLooks.size()]);
}

std::optional<std::size_t> place_of(std::string_view look) {
  const bool lighter = look.ends_with(kLight);
  look.remove_suffix(lighter ? kLight.size() : 0);
  for (std::size_t i = 0; i < kAvatarLooks.size(); ++i) {
    if (kAvatarLooks[i].name == look) {
      return lighter ? kAvatarLooks.size() + i : i;
    }
  }
  return std::nullopt;
}

}  // namespace

AvatarShelf::AvatarShelf() : AvatarShelf([](const AvatarLook& look) { return make_avatar(Shape{}, look); }) {}

AvatarShelf::AvatarShelf(Make make) : make_(std::move(make)), thread_([this] { work(); }) {}

AvatarShelf::~AvatarShelf() {
  stop();
  thread_.join();
}

void AvatarShelf::stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
}

bool AvatarShelf::has(std::string_view look) {
  return place_of(look).has_value();
}

bool AvatarShelf::get(std::string_view look, Ready ready) {
  const std::optional<std::size_t> place = place_of(look);
  if (!place) {
    return false;
  }
  Bytes bytes;
  {
    const std::lock_guard lock(mutex_);
    Place& at = places_[*place];
    if (!at.done) {
      wanted_ = *place;
      at.waiting.push_back(std::move(ready));
      changed_.notify_all();
      return true;
    }
    bytes = at.bytes;
  }
  ready(bytes);
  return true;
}

// From the one that was asked for on, but light ones only when somebody asks; with the lock.
std::optional<std::size_t> AvatarShelf::next() const {
  for (std::size_t step = 0; step < places_.size(); ++step) {
    const std::size_t i = (wanted_ + step) % places_.size();
    if (!places_[i].done && (i < kAvatarLooks.size() || !places_[i].waiting.empty())) {
      return i;
    }
  }
  return std::nullopt;
}

void AvatarShelf::work() {
  while (true) {
    std::size_t look = 0;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || next(); });
      if (stop_) {
        break;
      }
      look = *next();
    }
    Bytes bytes;
    try {
      bytes = std::make_shared<const std::string>(make_(look_at(look)));
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): null says it to whoever asks
    }
    put(look, std::move(bytes));
  }
  for (std::size_t look = 0; look < places_.size(); ++look) {
    put(look, nullptr);
  }
}

void AvatarShelf::put(std::size_t look, Bytes bytes) {
  std::vector<Ready> waiting;
  {
    const std::lock_guard lock(mutex_);
    Place& place = places_[look];
    if (place.done) {
      return;
    }
    place.done = true;
    place.bytes = bytes;
    waiting.swap(place.waiting);
  }
  for (const Ready& ready : waiting) {
    ready(bytes);
  }
}

}  // namespace telemime
