// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "telemime/capture/clock.h"
#include "telemime/capture/source.h"
#include "telemime/live/live_state.h"
#include "telemime/outputs/encoder.h"
#include "telemime/tracker/track_request.h"

namespace telemime {

/// What a user may answer in the guided start.
enum class GuideStep { empty, skip, again };

/// Called from the session's threads; none may block. All may be empty. `taken` of frames and motion is a
/// usable_stamp (live_statistics.h), s of the session's clock.
struct LiveHooks {
  std::function<void(const Frame&)> picture;        ///< each frame that is processed, before anything else
  std::function<void(const StreamHeader&)> person;  ///< a person was calibrated, whose frames follow
  std::function<void(const MotionFrame&, double taken)> motion;   ///< smoothed
  std::function<void(MessageLevel, const std::string&)> message;  ///< messages for the user
};

/// Tracks a live source in two threads (thesis 3.2, figure 3-2): the features of one frame are extracted
/// while the previous frame is searched. Each thread has at most one frame, and the source keeps the newest,
/// so nothing is late by more than the work in progress. With a source that drops no frame the poses are
/// those of track_frame(). If the camera is disconnected, the session waits for it. Changes of the camera are
/// reported by LiveHooks::message.
class LiveSession {
 public:
  /// `request`: input's name, background, camera, calibration file, configuration; the rest is not used.
  /// `guided` waits for the empty room if the scene is not known otherwise. Throws Error(config, input).
  LiveSession(const TrackRequest& request, bool guided, std::unique_ptr<Source> source, LiveHooks hooks,
              Clock clock = monotonic_clock());
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;
  ~LiveSession();  ///< stop()

  /// After it returns, no hook is called; state() may still be used. Waits for the work in progress,
  /// not for the camera.
  void stop();

  /// The next three may be called from any thread; they take effect at the next frame.
  void guide(GuideStep step);
  void recalibrate();
  LiveState state() const;

  const Camera& camera() const;  ///< of the input's images

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace telemime
