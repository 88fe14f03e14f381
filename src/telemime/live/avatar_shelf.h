// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <future>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include "telemime/avatar/look.h"

namespace telemime {

/// The project's own avatars, made one after the other in a thread of its own (each takes most of a second),
/// the one that was asked for next.
class AvatarShelf {
 public:
  AvatarShelf();
  AvatarShelf(const AvatarShelf&) = delete;
  AvatarShelf& operator=(const AvatarShelf&) = delete;
  ~AvatarShelf();  ///< does not wait for those that are not begun

  /// The VRM file of a look; waits while it is made. Null when there is no such look.
  std::shared_ptr<const std::string> get(std::string_view look) const;

 private:
  using Bytes = std::shared_ptr<const std::string>;
  std::array<std::promise<Bytes>, kAvatarLooks.size()> promises_;
  std::array<std::shared_future<Bytes>, kAvatarLooks.size()> avatars_;
  mutable std::atomic<std::size_t> wanted_ = 0;  ///< the one that is made next
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace telemime
