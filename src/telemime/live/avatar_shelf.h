// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "avatars/look.h"

namespace telemime {

/// The project's own avatars, made one after the other in a thread of its own (each takes most of a second),
/// the one that was asked for next. From any thread; nobody waits.
class AvatarShelf {
 public:
  using Bytes = std::shared_ptr<const std::string>;
  using Ready = std::function<void(Bytes)>;
  /// The VRM file of a look. What it throws makes that avatar one that cannot be had.
  using Make = std::function<std::string(const AvatarLook&)>;

  AvatarShelf();  ///< of make_avatar and a body of average shape
  explicit AvatarShelf(Make make);
  AvatarShelf(const AvatarShelf&) = delete;
  AvatarShelf& operator=(const AvatarShelf&) = delete;
  ~AvatarShelf();  ///< stop(), and waits for the one that is being made

  /// No other one is begun; who waits for one hears soon that there will be none.
  void stop();

  /// Whether get() knows the name.
  static bool has(std::string_view look);

  /// Calls `ready` once with the VRM file: at once when it is there, else from the shelf's thread when it is
  /// made; with null when it cannot be made or the shelf ends. False, and no call, when there is no such
  /// look. "<name>-light" is light(look) of avatar/look.h.
  bool get(std::string_view look, Ready ready);

 private:
  struct Place {
    bool done = false;
    Bytes bytes;  ///< null when it could not be made
    std::vector<Ready> waiting;
  };
  void work();
  std::optional<std::size_t> next() const;
  void put(std::size_t look, Bytes bytes);

  Make make_;
  std::mutex mutex_;  ///< of what follows
  std::condition_variable changed_;
  std::array<Place, 2 * kAvatarLooks.size()> places_;  ///< of the looks, then of the light ones
  std::size_t wanted_ = 0;                             ///< the one that is made next
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace telemime
