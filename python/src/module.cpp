// SPDX-License-Identifier: Apache-2.0
// The module _telemime: classes and functions in C++ behind the package telemime.
#include "bindings.h"
#include "cli/data_folder.h"
#include "frame.h"
#include "request.h"
#include "telemime/capture/prepare_opencv.h"

PYBIND11_MODULE(_telemime, module) {
  using namespace telemime::python;
  // NumPy sets environment variables while it is imported, and the threads of a run read them: import it
  // before any.
  pybind11::module_::import("numpy");
  telemime::prepare_opencv();
  translate_errors();
  bind_requests(module);
  bind_frames(module);
  bind_track(module);
  bind_tracker(module);
  bind_live(module);
  bind_evaluate(module);
  for (const char* const shown : {"Face", "Frame", "Hand", "Live", "Track"}) {
    module.attr(shown).attr("__module__") = "telemime";
  }
  module.def("data_folder", [] { return telemime::data_folder().string(); });
  module.attr("__version__") = TELEMIME_VERSION;
}
