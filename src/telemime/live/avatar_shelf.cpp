// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/avatar_shelf.h"

#include <cstddef>
#include <exception>

#include "telemime/avatar/avatar.h"

namespace telemime {

AvatarShelf::AvatarShelf() {
  for (std::size_t i = 0; i < promises_.size(); ++i) {
    avatars_[i] = promises_[i].get_future().share();
  }
  thread_ = std::thread([this] {
    std::array<bool, kAvatarLooks.size()> made{};
    for (std::size_t count = 0; count < made.size(); ++count) {
      std::size_t i = wanted_;
      while (made[i]) {
        i = (i + 1) % made.size();
      }
      made[i] = true;
      try {
        promises_[i].set_value(
            stop_ ? nullptr : std::make_shared<const std::string>(make_avatar(Shape{}, kAvatarLooks[i])));
      } catch (...) {
        promises_[i].set_exception(std::current_exception());
      }
    }
  });
}

AvatarShelf::~AvatarShelf() {
  stop_ = true;
  thread_.join();
}

std::shared_ptr<const std::string> AvatarShelf::get(std::string_view look) const {
  for (std::size_t i = 0; i < kAvatarLooks.size(); ++i) {
    if (kAvatarLooks[i].name == look) {
      wanted_ = i;
      return avatars_[i].get();
    }
  }
  return nullptr;
}

}  // namespace telemime
