// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "telemime/core/frame.h"
#include "telemime/likelihood/backend.h"
#include "telemime/live/live_state.h"
#include "telemime/live/video_output.h"
#include "telemime/outputs/encoder.h"

namespace telemime {

/// Shows the pictures of a live run, with the tracked body drawn on them (offline/overlay.h), as a camera for
/// other programs. It draws and writes in its own thread, the newest picture only: a slow or failing device
/// never delays the tracker. A device that fails is reported once and opened again every `retry`. All
/// functions may be called from any thread. Without an output it does nothing.
class VirtualCamera {
 public:
  using Message = std::function<void(MessageLevel, const std::string&)>;

  VirtualCamera(std::unique_ptr<VideoOutput> output, Message message,
                std::chrono::milliseconds retry = std::chrono::seconds(2));
  VirtualCamera(const VirtualCamera&) = delete;
  VirtualCamera& operator=(const VirtualCamera&) = delete;
  ~VirtualCamera();

  /// A picture, before its motion. It is shown as it is when the motion does not come with the next ones.
  void picture(const Frame& frame);
  /// The person of the motion that follows.
  void person(const StreamHeader& header);
  void motion(const MotionFrame& frame);

 private:
  struct Person {
    Model model;
    Camera camera;
  };
  struct Shown {
    Frame frame;
    std::optional<MotionFrame> motion;
    std::shared_ptr<const Person> person;
  };

  void show(Shown shown);
  void run();
  void report(MessageLevel level, const std::string& words) const;

  std::unique_ptr<VideoOutput> output_;
  const Message message_;
  const std::chrono::milliseconds retry_;
  std::atomic<bool> stop_ = false;

  std::mutex mutex_;  ///< guards the members below
  std::condition_variable changed_;
  std::shared_ptr<const Person> person_;
  std::deque<Frame> waiting_;  ///< for their motion
  std::optional<Shown> next_;
  std::thread thread_;
};

}  // namespace telemime
