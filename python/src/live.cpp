// SPDX-License-Identifier: Apache-2.0
// The class Live of Python: the newest frame of a live run.
#include <pybind11/stl.h>

#include <array>
#include <deque>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "bindings.h"
#include "telemime/capture/playback.h"
#include "telemime/core/errors.h"
#include "telemime/live/live_session.h"
#include "telemime/outputs/clean_frames.h"
#include "waiting.h"

namespace telemime::python {
namespace {

namespace py = pybind11;

const char* name_of(LivePhase phase) {
  constexpr std::array<const char*, 8> kNames = {"opening",  "empty_room", "background", "person",
                                                 "tracking", "lost",       "stopped",    "ended"};
  return kNames[static_cast<std::size_t>(phase)];
}

class LiveTrack {
 public:
  LiveTrack(const TrackRequest& request, bool repeat) {
    const py::gil_scoped_release others;
    LiveOptions options;
    options.input = request.input_options;
    LiveInput input = open_live_input(request.input, options, repeat);
    endless_ = input.camera || repeat;
    LiveHooks hooks;
    // The run calls both hooks one after the other, never at the same time.
    const auto clean = std::make_shared<CleanFrames>();
    hooks.person = [this, clean](const StreamHeader& header) {
      *clean = CleanFrames();  // a new person does not repeat the body of the one before
      const std::lock_guard lock(mutex_);
      header_ = std::make_shared<StreamHeader>(header);
    };
    hooks.motion = [this, clean](const MotionFrame& motion, double) {
      FramePointer frame = make_frame((*clean)(motion), header());
      {
        const std::lock_guard lock(mutex_);
        latest_ = frame;
      }
      frames_.put(std::move(frame));
    };
    hooks.message = [this](MessageLevel level, const std::string& words) {
      constexpr std::size_t kMost = 100;
      const std::lock_guard lock(mutex_);
      messages_.push_back(words);
      if (messages_.size() > kMost) {
        messages_.pop_front();
      }
      if (level == MessageLevel::error && error_.empty()) {
        error_ = words;
      }
    };
    session_ = std::make_unique<LiveSession>(request, false, std::move(input.source), std::move(hooks));
  }
  LiveTrack(const LiveTrack&) = delete;
  LiveTrack& operator=(const LiveTrack&) = delete;
  ~LiveTrack() { close(); }

  FramePointer next() {
    FramePointer frame = wait_for_frame(
        frames_, [this] { return frames_.closed() || session_->state().phase == LivePhase::ended; });
    if (!frame) {
      fail();
      throw py::stop_iteration();
    }
    return frame;
  }

  void close() {
    const py::gil_scoped_release others;
    frames_.close();
    if (session_) {
      session_->stop();
    }
  }

  void recalibrate() { session_->recalibrate(); }
  LiveState state() const { return session_->state(); }

  std::shared_ptr<const StreamHeader> header() const {
    const std::lock_guard lock(mutex_);
    return header_;
  }
  FramePointer latest() const {
    const std::lock_guard lock(mutex_);
    return latest_;
  }
  std::deque<std::string> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }

 private:
  // A camera that is gone, or an internal failure; a file just ends.
  void fail() const {
    {
      const std::lock_guard lock(mutex_);
      if (!error_.empty()) {
        throw std::runtime_error(error_);
      }
    }
    if (const LiveState state = session_->state(); endless_ && !frames_.closed() && !state.words.empty()) {
      throw Error(ErrorKind::input, state.words);
    }
  }

  bool endless_ = false;
  FrameQueue frames_{true};
  mutable std::mutex mutex_;  // of what follows
  std::shared_ptr<const StreamHeader> header_;
  FramePointer latest_;
  std::deque<std::string> messages_;
  std::string error_;
  std::unique_ptr<LiveSession> session_;  // its threads use all of the above
};

}  // namespace

void bind_live(py::module_& module) {
  py::class_<LiveTrack>(
      module, "Live",
      "A live run: an iterator over the newest frames, which drops those that come while you\n"
      "work. Made by live(); leave it by close() or `with`.")
      .def(py::init<const TrackRequest&, bool>())
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &LiveTrack::next)
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](LiveTrack& self, const py::args&) { self.close(); })
      .def("close", &LiveTrack::close, "Ends the run and closes the camera.")
      .def("recalibrate", &LiveTrack::recalibrate, "The next images calibrate the person that they show.")
      .def_property_readonly("latest", &LiveTrack::latest,
                             "The newest frame, without waiting; None before the first.")
      .def_property_readonly(
          "phase", [](const LiveTrack& self) { return name_of(self.state().phase); },
          "What the run does: opening, background, person, tracking, lost, stopped or ended.")
      .def_property_readonly(
          "note", [](const LiveTrack& self) { return self.state().words; },
          "Why nobody is tracked, or what the run waits for; or empty.")
      .def_property_readonly(
          "warnings", [](const LiveTrack& self) { return self.state().warnings; },
          "What makes results worse now, with remedies.")
      .def_property_readonly("messages", &LiveTrack::messages, "Notes so far, at most the newest hundred.")
      .def_property_readonly(
          "header", [](const LiveTrack& self) { return header_dictionary(self.header()); },
          "Camera, body and settings, as the first line of pose.jsonl has them; None until a\n"
          "person is calibrated.");
}

}  // namespace telemime::python
