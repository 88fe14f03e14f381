// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include "telemime/capture/source.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/tracker/track_request.h"

namespace telemime::live_testing {

/// The images of a camera, repeated; a test can change them during a run.
class ScriptedScene {
 public:
  /// Without frames, the camera delivers nothing until there are some.
  void show(std::vector<Frame> frames);
  /// The camera ends permanently.
  void end();
  /// Like Source::stop: from any thread.
  void stop();
  std::optional<Frame> next();
  const Frame& first() const { return first_; }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Frame> frames_;
  Frame first_;
  std::size_t at_ = 0;
  std::int64_t count_ = 0;
  bool ended_ = false;
};

/// A camera that delivers the scene, at most one image per millisecond. `scene` must have frames.
std::unique_ptr<Source> camera_of(std::shared_ptr<ScriptedScene> scene);

/// A scene with the synthetic person.
std::shared_ptr<ScriptedScene> person_scene();

/// A request for a quick tracker (few pixels, few evaluations) with the background as a folder of images.
TrackRequest quick_request(const ScratchFolder& folder);

/// The synthetic person and the empty scene, rendered once.
const std::vector<Frame>& person();
const std::vector<Frame>& empty_room();
/// The person, repeated; indices and times increase as in a file.
std::vector<Frame> person_repeated(int times);

}  // namespace telemime::live_testing
