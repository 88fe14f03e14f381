// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "telemime/core/frame.h"

namespace telemime {

/// What is known of an input before its frames are read.
struct SourceInfo {
  std::string name;  ///< as the user gave it; of a stream fit to be shown (shown_url())
  int width = 0;     ///< of the first frame
  int height = 0;
  double fps = 25.0;        ///< stated by the input, or measured, or 25 when it says nothing usable
  std::int64_t frames = 0;  ///< 0: not known (camera, stream)
  bool live = false;        ///< frames come in real time and may be dropped
};

/// What happens to a camera while it is used.
struct SourceNews {
  enum class Kind {
    worse,   ///< something is not as good as it was
    gone,    ///< no picture has come for some time
    better,  ///< what was worse or gone is over
  };
  /// What it is about: "better" ends what was worse or gone there.
  enum class Matter { presence, size, rate, damage };
  Kind kind = Kind::worse;
  std::string words;  ///< for the user
  Matter matter = Matter::presence;
};

/// A sequence of frames. File inputs never drop a frame; live inputs keep the newest.
class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;
  virtual const SourceInfo& info() const = 0;
  /// The next frame, or nothing at the end. A frame of another size than the first is resized to it.
  virtual std::optional<Frame> next() = 0;
  /// From any thread: a next() that waits for a camera gives nothing, now and from now on. Files never wait.
  virtual void stop() {}
  /// Before the first next(), by who follows a camera for as long as it takes: one that is gone is waited for
  /// until stop(), and what happens to it is told at once, from within next(). Files have nothing to tell.
  virtual void attend(std::function<void(const SourceNews&)> /*tell*/) {}
  /// Words about what went wrong on the way (truncated file, stream interrupted); empty when nothing did.
  virtual std::string complaint() const = 0;
};

/// Opens a video file, an image folder, an image pattern (frame_%04d.png, *.jpg), a stream URL, a camera
/// index ("0") or device ("/dev/video0"). Throws Error(input) whose message says which kind it was taken for,
/// the cause (no such file, empty file, not a video, no frame in it) and what to do.
std::unique_ptr<Source> open_source(const std::string& input);

}  // namespace telemime
