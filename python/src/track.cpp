// SPDX-License-Identifier: Apache-2.0
// The class Track of Python: the frames of a file as `telemime track` writes them.
#include <pybind11/stl.h>

#include <exception>
#include <memory>
#include <thread>

#include "bindings.h"
#include "telemime/offline/track_file.h"
#include "telemime/outputs/clean_frames.h"
#include "waiting.h"

namespace telemime::python {
namespace {

namespace py = pybind11;

/// A run of track_file() in a thread of its own, from the first frame that is asked for.
class FileTrack {
 public:
  explicit FileTrack(TrackRequest request) : request_(std::move(request)) {}
  FileTrack(const FileTrack&) = delete;
  FileTrack& operator=(const FileTrack&) = delete;
  ~FileTrack() { close(); }

  FramePointer next() {
    {
      const py::gil_scoped_release others;
      const std::lock_guard lock(run_mutex_);
      if (!run_.joinable() && !frames_.closed()) {
        run_ = std::thread([this] { work(); });
      }
    }
    FramePointer frame = wait_for_frame(frames_, [this] { return frames_.closed(); });
    if (!frame) {
      close();
      if (failure_) {
        std::rethrow_exception(std::exchange(failure_, nullptr));
      }
      throw py::stop_iteration();
    }
    return frame;
  }

  /// Ends the run: soon, but not before it has read what it learns the scene from.
  void close() {
    const py::gil_scoped_release others;
    frames_.close();
    const std::lock_guard lock(run_mutex_);  // another thread may wait for the end, too
    if (run_.joinable()) {
      run_.join();
    }
  }

  std::shared_ptr<const StreamHeader> header() const {
    const std::lock_guard lock(mutex_);
    return header_;
  }
  std::vector<std::string> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }
  py::object report() const {
    const std::lock_guard lock(mutex_);
    return dictionary(report_);
  }

 private:
  void work() {
    RunHooks hooks;
    hooks.progress = [this](const Progress&) {
      return frames_.closed() ? ViewerRequest::stop : ViewerRequest::none;
    };
    hooks.message = [this](const std::string& words) {
      const std::lock_guard lock(mutex_);
      messages_.push_back(words);
    };
    hooks.person = [this](const StreamHeader& header) {
      const std::lock_guard lock(mutex_);
      header_ = std::make_shared<StreamHeader>(header);
    };
    hooks.motion = [this, clean = CleanFrames()](const MotionFrame& motion) mutable {
      frames_.put(make_frame(clean(motion), header()));
    };
    try {
      const TrackSummary summary = track_file(request_, hooks);
      const std::lock_guard lock(mutex_);
      report_ = summary.report;
    } catch (...) {
      failure_ = std::current_exception();
    }
    frames_.close();
  }

  const TrackRequest request_;
  FrameQueue frames_{false};
  std::mutex run_mutex_;  ///< of the thread's start and end
  std::thread run_;
  std::exception_ptr failure_;  ///< of the run, once it has ended
  mutable std::mutex mutex_;    ///< of what follows
  std::shared_ptr<const StreamHeader> header_;
  std::vector<std::string> messages_;
  nlohmann::json report_;
};

}  // namespace

void bind_track(py::module_& module) {
  py::class_<FileTrack>(module, "Track", "The frames of a file, one after the other. Made by track().")
      .def(py::init<TrackRequest>())
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &FileTrack::next)
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](FileTrack& self, const py::args&) { self.close(); })
      .def(
          "close", &FileTrack::close,
          "Ends the run; files that it writes are valid. What has read the input to learn the scene goes on\n"
          "until it has.")
      .def_property_readonly(
          "header", [](const FileTrack& self) { return header_dictionary(self.header()); },
          "What the first line of pose.jsonl says: camera, body, settings. None before the\n"
          "first frame.")
      .def_property_readonly("messages", &FileTrack::messages, "Notes about the run so far.")
      .def_property_readonly("report", &FileTrack::report,
                             "What report.json says, once the run has ended; before it None.");
}

}  // namespace telemime::python
