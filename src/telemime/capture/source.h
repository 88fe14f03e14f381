// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "telemime/core/frame.h"

namespace telemime {

/// What the user knows about an input that it does not state itself.
struct InputOptions {
  /// Frames (or numbers of images) per second; 0: by the time stamps, or 25. For images, and for videos whose
  /// own times are wrong.
  double rate = 0.0;
  bool mirrored = false;  ///< the pictures are mirror images: they are mirrored back
};

/// Properties of an input that are known before its frames are read.
struct SourceInfo {
  std::string name;  ///< as the user gave it; for a stream without secrets (shown_url())
  int width = 0;     ///< of the first frame
  int height = 0;
  double fps = 25.0;          ///< by the time stamps where they do not confirm what is stated; else 25
  std::int64_t frames = 0;    ///< 0: unknown (camera, stream)
  bool live = false;          ///< frames come in real time and may be dropped
  double pixel_aspect = 1.0;  ///< width of a stored pixel by its height; frames are resized to square pixels
};

/// A change in the condition of a camera during a run.
struct SourceNews {
  enum class Kind {
    worse,   ///< a problem has appeared
    gone,    ///< no image has arrived for some time
    better,  ///< a problem is over
  };
  /// The kind of problem: `better` ends the `worse` or `gone` of the same matter.
  enum class Matter { presence, size, rate, damage };
  Kind kind = Kind::worse;
  std::string words;  ///< message for the user
  Matter matter = Matter::presence;
};

/// A sequence of frames. File inputs never drop a frame; live inputs keep only the newest.
class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;
  virtual const SourceInfo& info() const = 0;
  /// The next frame; empty at the end. Frames of another size than the first are resized to it.
  virtual std::optional<Frame> next() = 0;
  /// Makes next() return an empty result from now on, also if it is waiting for a camera. Can be called from
  /// any thread. Files never wait.
  virtual void stop() {}
  /// Waits for a camera that is gone until stop(), and reports changes of its condition by calling `report`
  /// from within next(). To be called before the first next(). Files ignore it.
  // NOLINTNEXTLINE(performance-unnecessary-value-param): those that report keep it
  virtual void attend(std::function<void(const SourceNews&)> /*report*/) {}
  /// Problems while reading so far (truncated file, interrupted stream) as text; empty if there were none.
  virtual std::string complaint() const = 0;
};

/// Opens a video file, an image folder, an image pattern (frame_%04d.png, *.jpg), a stream URL, a camera
/// index ("0") or device ("/dev/video0"). Throws Error(input) that states the assumed kind of input, the
/// cause (no such file, empty file, not a video, no frame in it) and a remedy.
std::unique_ptr<Source> open_source(const std::string& input, const InputOptions& options = {});

}  // namespace telemime
