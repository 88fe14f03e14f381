// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "telemime/capture/source.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/tracker/track_request.h"

namespace telemime::live_testing {

/// What a camera shows, for a test to change while it runs: the same pictures again and again.
class Scene {
 public:
  /// No frames: the camera gives nothing until there are some.
  void show(std::vector<Frame> frames);
  /// The camera is unplugged for good.
  void end();
  /// Of a Source: from any thread.
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

/// A camera that shows the scene, a picture each millisecond or slower. `scene` must show something already.
std::unique_ptr<Source> camera_of(std::shared_ptr<Scene> scene);

/// A quick tracker, with the empty room in a folder of pictures; few pixels, few evaluations.
TrackRequest quick_request(const ScratchFolder& folder);

/// The synthetic person and the room, rendered once.
const std::vector<Frame>& person();
const std::vector<Frame>& empty_room();

}  // namespace telemime::live_testing
