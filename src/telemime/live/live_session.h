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
  std::function<void(const Frame&)> picture;        ///< each frame that is looked at, first of all
  std::function<void(const StreamHeader&)> person;  ///< a person was calibrated: their frames follow
  std::function<void(const MotionFrame&, double taken)> motion;   ///< smoothed
  std::function<void(MessageLevel, const std::string&)> message;  ///< messages for the user
};

/// Tracks a live source in two threads (thesis 3.2, figure 3-2): features of one frame beside the search of
/// the one before. Each thread has one frame at most and the source keeps the newest, so nothing is ever late
/// by more than the work in hand. A source that drops no frame gives the poses that track_frame() gives
/// one after the other. A camera that is gone is waited for, and its changes are reported by
/// LiveHooks::message.
class LiveSession {
 public:
  /// `request`: input's name, background, camera, calibration file, configuration; the rest is not used.
  /// `guided` waits for the empty room where nothing else teaches the scene. Throws Error(config, input).
  LiveSession(const TrackRequest& request, bool guided, std::unique_ptr<Source> source, LiveHooks hooks,
              Clock clock = monotonic_clock());
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;
  ~LiveSession();  ///< stop()

  /// When it returns no hook is called any more; the rest may still be asked. Waits for the work in hand, not
  /// for the camera.
  void stop();

  /// The next three from any thread; they act at the next frame.
  void guide(GuideStep step);
  void recalibrate();
  LiveState state() const;

  const SourceInfo& info() const;
  const Camera& camera() const;  ///< of the input's pictures

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace telemime
