// SPDX-License-Identifier: Apache-2.0
// The class Tracker of Python: tracks the images that it is given.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "bindings.h"
#include "frame.h"
#include "telemime/core/errors.h"
#include "telemime/outputs/clean_frames.h"
#include "telemime/tracker/scene.h"
#include "telemime/tracker/set_up.h"
#include "telemime/tracker/smoother.h"
#include "telemime/tracker/track_frame.h"

namespace telemime::python {
namespace {

namespace py = pybind11;

/// The source of one image after the other.
class GivenImages final : public Source {
 public:
  GivenImages(int width, int height) {
    info_.name = "given images";
    info_.width = width;
    info_.height = height;
    info_.live = true;
  }
  void give(Frame frame) { frame_ = std::move(frame); }
  const SourceInfo& info() const override { return info_; }
  std::optional<Frame> next() override { return std::exchange(frame_, std::nullopt); }
  std::string complaint() const override { return {}; }

 private:
  SourceInfo info_;
  std::optional<Frame> frame_;
};

std::string shape_of(const py::array& image) {
  return py::str(image.attr("shape"));
}

/// The image as OpenCV sees it: the memory of the array where its pixels lie side by side in the order that
/// the tracker reads; else a copy.
struct GivenImage {
  py::array owner;
  cv::Mat view;
  int conversion = -1;  ///< of cv::cvtColor; -1: none

  GivenImage(const py::object& object, int width, int height, bool rgb) {
    if (!py::isinstance<py::array>(object)) {
      throw py::type_error("the image must be a NumPy array, not " +
                           std::string(py::str(py::type::of(object).attr("__name__"))));
    }
    owner = py::array(object);
    if (!py::isinstance<py::array_t<std::uint8_t>>(owner)) {
      throw py::type_error("the image must have the type uint8, not " + std::string(py::str(owner.dtype())));
    }
    const bool grey = owner.ndim() == 2 || (owner.ndim() == 3 && owner.shape(2) == 1);
    if (!grey && (owner.ndim() != 3 || owner.shape(2) != 3)) {
      throw py::value_error("the image must have the shape (height, width, 3) or (height, width), not " +
                            shape_of(owner));
    }
    if (owner.shape(0) != height || owner.shape(1) != width) {
      throw py::value_error("the tracker was made for images of " + std::to_string(width) + "x" +
                            std::to_string(height) + " pixels, and this one has the shape " +
                            shape_of(owner));
    }
    const py::ssize_t pixel = grey ? 1 : 3;
    const bool dense = owner.strides(1) == pixel && owner.strides(0) >= pixel * width &&
                       (owner.ndim() == 2 || owner.strides(2) == 1);
    if (!dense) {
      owner = py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>::ensure(owner);
    }
    view = cv::Mat(height, width, grey ? CV_8UC1 : CV_8UC3, const_cast<void*>(owner.data()),
                   static_cast<std::size_t>(owner.strides(0)));
    conversion = grey ? cv::COLOR_GRAY2BGR : rgb ? cv::COLOR_RGB2BGR : -1;
  }

  cv::Mat bgr() const {
    if (conversion < 0) {
      return view;
    }
    cv::Mat converted;  // not into the array
    cv::cvtColor(view, converted, conversion);
    return converted;
  }
};

class ImageTracker {
 public:
  ImageTracker(int width, int height, TrackRequest request, bool rgb)
      : request_(std::move(request)), width_(width), height_(height), rgb_(rgb) {
    if (width < 1 || height < 1) {
      throw py::value_error("the images must have a width and a height of at least one pixel");
    }
    const py::gil_scoped_release others;
    request_.config.look_back = false;  // no later frame changes an earlier one
    auto images = std::make_unique<GivenImages>(width, height);
    images_ = images.get();
    source_ = without_distortion(std::move(images), request_);
    run_.emplace(open_run(request_, source_->info(), messages_));
    if (!request_.background.empty() && request_.calibration.empty()) {
      messages_.push_back(learn_scene(request_, source_->info(), *run_));
    }
  }

  FramePointer step(const py::object& object, double time) {
    const GivenImage image(object, width_, height_, rgb_);
    const py::gil_scoped_release others;
    const std::unique_lock lock = alone();
    if (!std::isfinite(time) || (last_ && time <= *last_)) {
      throw py::value_error("the time of an image must be later than that of the image before: " +
                            std::to_string(time) + " s after " + (last_ ? std::to_string(*last_) : "none"));
    }
    first_ = first_.value_or(time);
    last_ = time;
    const FrameRecord record =
        track_frame(*undistorted({.image = image.bgr(), .index = count_++, .time = time - *first_}), *run_);
    note_ = record.estimate.note;
    if (run_->state.person && !smoother_) {
      header_ = std::make_shared<StreamHeader>(header_of(source_->info(), *run_));
      smoother_ = make_smoother(request_.config.smoothing, header_->body, header_->camera);
    }
    MotionFrame motion = clean_(smoother_ ? (*smoother_)(record.estimate.motion) : record.estimate.motion);
    motion.time += *first_;
    return make_frame(motion, header_);
  }

  void learn_background(const py::iterable& images) {
    std::vector<Frame> frames;
    for (const py::handle& object : images) {
      const GivenImage image(py::reinterpret_borrow<py::object>(object), width_, height_, rgb_);
      frames.push_back(*undistorted({.image = image.bgr().clone(), .index = std::ssize(frames)}));
    }
    const py::gil_scoped_release others;
    const std::unique_lock lock = alone();
    run_->scene.features.learn_background(frames);
  }

  void forget_person() {
    const std::unique_lock lock = alone();
    telemime::forget_person(*run_);
    smoother_.reset();
    clean_ = CleanFrames();
    header_.reset();
  }

  std::shared_ptr<const StreamHeader> header() const {
    const std::unique_lock lock = alone();
    return header_;
  }
  std::string note() const {
    const std::unique_lock lock = alone();
    return note_;
  }
  std::vector<std::string> messages() const { return messages_; }

 private:
  std::unique_lock<std::mutex> alone() const {
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) {
      throw std::runtime_error("another thread uses this tracker: each thread needs its own");
    }
    return lock;
  }

  std::optional<Frame> undistorted(Frame frame) {
    images_->give(std::move(frame));
    return source_->next();
  }

  TrackRequest request_;
  const int width_;
  const int height_;
  const bool rgb_;
  std::vector<std::string> messages_;
  GivenImages* images_ = nullptr;  ///< behind source_
  std::unique_ptr<Source> source_;
  std::optional<TrackingRun> run_;
  std::unique_ptr<Smoother> smoother_;  ///< since a person was calibrated
  std::shared_ptr<const StreamHeader> header_;
  CleanFrames clean_;
  std::string note_;
  std::int64_t count_ = 0;
  std::optional<double> first_, last_;  ///< times of images, s
  mutable std::mutex mutex_;
};

}  // namespace

void bind_tracker(py::module_& module) {
  py::class_<ImageTracker>(module, "Tracker", "Tracks a person in the images that it is given, as they come.")
      .def(py::init<int, int, TrackRequest, bool>())
      .def("step", &ImageTracker::step, py::arg("image"), py::arg("time"),
           "Tracks the next image.\n\n"
           "image: NumPy array of uint8 with the shape (height, width, 3) or, grey, (height, width). It is "
           "not\n"
           "copied where its pixels lie side by side in the order BGR.\n"
           "time: when it was taken, in seconds of any clock; later than the image before.\n\n"
           "Returns the Frame. Raises TypeError or ValueError for an image or a time that cannot be used.")
      .def("learn_background", &ImageTracker::learn_background, py::arg("images"),
           "Learns the scene from images without a person, before the first step. Only trackers without\n"
           "networks need it.")
      .def("forget_person", &ImageTracker::forget_person,
           "The next images calibrate the person that they show.")
      .def_property_readonly(
          "header", [](const ImageTracker& self) { return header_dictionary(self.header()); },
          "Camera, body and settings, as the first line of pose.jsonl has them; None until a\n"
          "person is calibrated.")
      .def_property_readonly("note", &ImageTracker::note,
                             "Why nobody is tracked in the last image; or empty.")
      .def_property_readonly("messages", &ImageTracker::messages, "Notes about the start.");
}

}  // namespace telemime::python
