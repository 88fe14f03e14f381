// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/virtual_camera.h"

#include <exception>
#include <utility>

#include "telemime/offline/overlay.h"

namespace telemime {
namespace {

// One frame is searched and one is prepared while the next one comes: a frame without motion by then has
// none.
constexpr std::size_t kMostWaiting = 3;

}  // namespace

VirtualCamera::VirtualCamera(std::unique_ptr<VideoOutput> output, Message message,
                             std::chrono::milliseconds retry)
    : output_(std::move(output)), message_(std::move(message)), retry_(retry) {
  if (output_) {
    thread_ = std::thread([this] { run(); });
  }
}

VirtualCamera::~VirtualCamera() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void VirtualCamera::picture(const Frame& frame) {
  if (!output_) {
    return;
  }
  const std::lock_guard lock(mutex_);
  waiting_.push_back(frame);
  if (waiting_.size() > kMostWaiting) {
    show({std::move(waiting_.front()), std::nullopt, nullptr});
    waiting_.pop_front();
  }
}

void VirtualCamera::person(const StreamHeader& header) {
  if (!output_) {
    return;
  }
  auto person = std::make_shared<const Person>(Person{make_model(header.body.shape), header.camera});
  const std::lock_guard lock(mutex_);
  person_ = std::move(person);
}

void VirtualCamera::motion(const MotionFrame& frame) {
  const std::lock_guard lock(mutex_);
  while (!waiting_.empty() && waiting_.front().index < frame.frame) {  // earlier ones come too late now
    waiting_.pop_front();
  }
  if (!waiting_.empty() && waiting_.front().index == frame.frame) {
    show({std::move(waiting_.front()), frame, person_});
    waiting_.pop_front();
  }
}

void VirtualCamera::show(Shown shown) {
  next_ = std::move(shown);
  changed_.notify_all();
}

void VirtualCamera::report(MessageLevel level, const std::string& words) const {
  if (message_) {
    message_(level, words);
  }
}

void VirtualCamera::run() {
  bool failing = false;
  while (true) {
    Shown shown;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || next_; });
      if (stop_) {
        return;
      }
      shown = *std::exchange(next_, std::nullopt);
    }
    try {
      cv::Mat picture = shown.frame.image;
      if (shown.person && shown.motion && shown.motion->state == TrackState::tracking) {
        OverlayView view;
        view.motion = &*shown.motion;
        view.model = &shown.person->model;
        view.camera = shown.person->camera;
        picture = draw_overlay(picture, view).colRange(0, picture.cols);  // without its panel
      }
      output_->write(picture, stop_);
      if (std::exchange(failing, false)) {
        report(MessageLevel::info, "the virtual camera " + output_->path().string() + " works again");
      }
    } catch (const std::exception& e) {  // the tracking goes on
      if (!std::exchange(failing, true)) {
        report(MessageLevel::warning, std::string(e.what()) + "\n  It is tried again.");
      }
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, retry_, [this] { return stop_.load(); });
    }
  }
}

}  // namespace telemime
