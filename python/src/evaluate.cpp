// SPDX-License-Identifier: Apache-2.0
// The function evaluate() of Python.
#include "telemime/evaluation/evaluate.h"

#include <pybind11/stl.h>

#include <algorithm>

#include "bindings.h"
#include "frame.h"
#include "telemime/evaluation/report.h"
#include "telemime/outputs/readers/jsonl.h"

namespace telemime::python {
namespace {

namespace py = pybind11;

// Frames of a run, with its camera.
PoseFile poses_of(const std::vector<FramePointer>& frames) {
  const auto known =
      std::find_if(frames.begin(), frames.end(), [](const FramePointer& f) { return f->header; });
  if (known == frames.end()) {
    throw py::value_error("in none of the " + std::to_string(frames.size()) +
                          " frames a person was found yet");
  }
  PoseFile file;
  file.camera = (*known)->header->camera;
  for (const FramePointer& frame : frames) {
    // A live run ends, and is calibrated again, with its last frame once more, as lost.
    const bool repeated = !file.frames.empty() && frame->motion.frame == file.frames.back().frame &&
                          frame->motion.state == TrackState::lost;
    if (repeated) {
      continue;
    }
    if (!file.frames.empty() && frame->motion.frame <= file.frames.back().frame) {
      throw py::value_error("the frames must come in the order of their numbers");
    }
    file.frames.push_back(frame->motion);
  }
  return file;
}

py::object measures(const PoseFile& poses, const std::string& truth, bool by_time, double max_f,
                    double max_dc) {
  nlohmann::ordered_json json;
  {
    const py::gil_scoped_release others;
    json = evaluation_json(
        evaluate(poses.frames, poses.camera, read_truth(truth),
                 {.max_region_score = max_f, .max_contour_score = max_dc, .by_time = by_time}));
  }
  return dictionary(json);
}

}  // namespace

void bind_evaluate(py::module_& module) {
  module.def("evaluate_frames",
             [](const std::vector<FramePointer>& frames, const std::string& truth, bool by_time, double max_f,
                double max_dc) { return measures(poses_of(frames), truth, by_time, max_f, max_dc); });
  module.def("evaluate_file",
             [](const std::string& pose, const std::string& truth, bool by_time, double max_f,
                double max_dc) { return measures(read_pose_jsonl(pose), truth, by_time, max_f, max_dc); });
}

}  // namespace telemime::python
