// SPDX-License-Identifier: Apache-2.0
#include "request.h"

#include <pybind11/stl.h>

#include <utility>

#include "telemime/core/errors.h"
#include "telemime/live/pace.h"
#include "telemime/outputs/all.h"

namespace telemime::python {
namespace {

namespace py = pybind11;

// `settings` is JSON: names with dots, or nested objects.
TrackRequest make_request(const std::string& settings, const std::string& input,
                          const std::string& background, const std::string& camera,
                          const std::string& calibration, double rate, bool mirrored, const std::string& out,
                          std::vector<std::string> formats, std::int64_t frames) {
  if (frames < 0) {
    throw Error(ErrorKind::usage, "frames is " + std::to_string(frames) + ", but must not be negative",
                "0 is all of them.");
  }
  constexpr double kLowestRate = 0.001, kHighestRate = 1000.0;
  if (rate != 0.0 && !(rate >= kLowestRate && rate <= kHighestRate)) {
    throw Error(ErrorKind::usage,
                "rate must be between 0.001 and 1000 frames a second, or 0: as the file says");
  }
  for (const std::string& format : formats) {
    output_format(format);  // throws for an unknown one
  }
  TrackRequest request;
  request.version = TELEMIME_VERSION;
  request.input = input;
  request.input_options = {.rate = rate, .mirrored = mirrored};
  request.background = background;
  request.camera = camera;
  request.calibration = calibration;
  request.out = out;
  request.formats = std::move(formats);
  request.most_frames = frames;
  const SettingValues values = parse_settings(settings, "of the argument settings");
  update(request.config, values);
  request.keep_pace = keeps_pace(values);
  return request;
}

}  // namespace

void bind_requests(py::module_& module) {
  py::class_<TrackRequest>(module, "Request")
      .def(py::init(&make_request), py::kw_only(), py::arg("settings"), py::arg("input") = "",
           py::arg("background") = "", py::arg("camera") = "", py::arg("calibration") = "",
           py::arg("rate") = 0.0, py::arg("mirrored") = false, py::arg("out") = "",
           py::arg("formats") = std::vector<std::string>(), py::arg("frames") = 0);
}

void translate_errors() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) {
        std::rethrow_exception(std::move(thrown));
      }
    } catch (const Error& error) {
      const bool asked = error.kind() == ErrorKind::usage || error.kind() == ErrorKind::config;
      const bool files = error.kind() == ErrorKind::input || error.kind() == ErrorKind::output;
      PyErr_SetString(asked ? PyExc_ValueError : files ? PyExc_OSError : PyExc_RuntimeError, error.what());
    }
  });
}

}  // namespace telemime::python
