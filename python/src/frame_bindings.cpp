// SPDX-License-Identifier: Apache-2.0
// The classes Frame, Hand and Face of Python.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "frame.h"

namespace telemime::python {
namespace {

namespace py = pybind11;

// A read-only array of the numbers of `values`, which belong to `owner` and keep it alive.
template <typename Values>
py::array view(const py::object& owner, const Values& values, std::vector<py::ssize_t> shape) {
  py::array array(py::dtype::of<double>(), std::move(shape), &values, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

// The rows of an array by their names.
template <typename Names>
py::dict by_name(const py::array& rows, const Names& names) {
  py::dict dictionary;
  for (std::size_t i = 0; i < names.size(); ++i) {
    dictionary[py::str(names[i].data(), names[i].size())] = rows[py::int_(i)];
  }
  return dictionary;
}

// A property: an array that looks into a member.
template <typename Object, typename Values>
auto array_at(Values Object::*values, std::vector<py::ssize_t> shape) {
  return [values, shape = std::move(shape)](const py::object& self) {
    return view(self, self.cast<const Object&>().*values, shape);
  };
}

// A property: the rows of that array by their names.
template <typename Object, typename Values, typename Names>
auto named_rows(Values Object::*values, std::vector<py::ssize_t> shape, const Names& names) {
  return [rows = array_at(values, std::move(shape)), &names](const py::object& self) {
    return by_name(rows(self), names);
  };
}

py::object spread_of(const py::object& self) {
  const auto& frame = self.cast<const FrameObject&>();
  return frame.spread ? py::object(view(self, *frame.spread, {kJointCount, 3, 3})) : py::none();
}

void bind_hands(py::module_& module) {
  py::class_<HandObject>(module, "Hand", "One hand of a frame, in millimetres and degrees (docs/hands.md).")
      .def_readonly("visibility", &HandObject::visibility, "From 0 (not seen, at rest) to 1.")
      .def_readonly("spread", &HandObject::spread,
                    "Standard deviation of a joint relative to the wrist, in millimetres.")
      .def_property_readonly("wrist", array_at(&HandObject::wrist, {3}),
                             "Twisting, pivot and flexion of the wrist as the hand shows it, in degrees.")
      .def_property_readonly("angles_array", array_at(&HandObject::angles, {kHandAngleCount}),
                             "Angles of the fingers in degrees, in the order of HAND_ANGLES.")
      .def_property_readonly("angles", named_rows(&HandObject::angles, {kHandAngleCount}, kHandAngleNames),
                             "The same by name.")
      .def_property_readonly("joints_array", array_at(&HandObject::joints, {kHandJointCount, 3}),
                             "Places of the joints (21, 3) in millimetres, in the order of HAND_JOINTS.")
      .def_property_readonly("joints", named_rows(&HandObject::joints, {kHandJointCount, 3}, kHandJointNames),
                             "The same by name.");
}

void bind_faces(py::module_& module) {
  py::class_<FaceObject>(module, "Face", "The face of a frame (docs/face.md).")
      .def_readonly("confidence", &FaceObject::confidence, "From 0 (not seen, at rest) to 1.")
      .def_property_readonly("head", array_at(&FaceObject::head, {4}),
                             "Rotation of the head in the camera frame, a quaternion x, y, z, w.")
      .def_property_readonly("gaze", array_at(&FaceObject::gaze, {2}),
                             "Direction of the eyes in the head, in degrees: to the person's left, and up.")
      .def_property_readonly("expressions_array", array_at(&FaceObject::expressions, {kExpressionCount}),
                             "The coefficients of ARKit (52), from 0 to 1, in the order of EXPRESSIONS.")
      .def_property_readonly("expressions",
                             named_rows(&FaceObject::expressions, {kExpressionCount}, kExpressionNames),
                             "The same by name.");
}

std::string description(const FrameObject& frame) {
  char words[80];
  std::snprintf(words, sizeof words, "<telemime.Frame %lld at %.3f s, %s>",
                static_cast<long long>(frame.motion.frame), frame.motion.time,
                frame.motion.state == TrackState::tracking ? "tracking" : "lost");
  return words;
}

template <typename Names>
py::tuple tuple_of(const Names& names) {
  py::tuple tuple(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    tuple[i] = py::str(names[i].data(), names[i].size());
  }
  return tuple;
}

}  // namespace

void bind_frames(py::module_& module) {
  module.attr("JOINTS") = tuple_of(kJointNames);
  module.attr("ANGLES") = tuple_of(kAngleNames);
  module.attr("HAND_JOINTS") = tuple_of(kHandJointNames);
  module.attr("HAND_ANGLES") = tuple_of(kHandAngleNames);
  module.attr("EXPRESSIONS") = tuple_of(kExpressionNames);
  bind_hands(module);
  bind_faces(module);
  const auto of_spread = [](double PoseSpread::*number) {
    return [number](const FrameObject& frame) {
      return frame.motion.spread ? std::optional(*frame.motion.spread.*number) : std::nullopt;
    };
  };
  py::class_<FrameObject, FramePointer>(
      module, "Frame",
      "What was found in one image: lengths in millimetres in the camera frame (x right, y down, z "
      "forward),\n"
      "angles in degrees. Arrays are read-only and look into the frame, which they keep alive.")
      .def_property_readonly(
          "number", [](const FrameObject& frame) { return frame.motion.frame; },
          "Number of the input's frame, from 0.")
      .def_property_readonly(
          "time", [](const FrameObject& frame) { return frame.motion.time; }, "Time in seconds.")
      .def_property_readonly(
          "lost", [](const FrameObject& frame) { return frame.motion.state == TrackState::lost; },
          "Whether nobody is tracked: the pose is the last known one then.")
      .def_property_readonly("root", array_at(&FrameObject::root, {3}), "Place of the root in millimetres.")
      .def_property_readonly("joints_array", array_at(&FrameObject::joints, {kJointCount, 3}),
                             "Places of the joints (12, 3) in millimetres, in the order of JOINTS.")
      .def_property_readonly("joints", named_rows(&FrameObject::joints, {kJointCount, 3}, kJointNames),
                             "The same by name: joints[\"l_wrist\"] is x, y, z.")
      .def_property_readonly("pixels_array", array_at(&FrameObject::pixels, {kJointCount, 2}),
                             "The joints in pixels (12, 2) of the input's image, in the order of JOINTS.")
      .def_property_readonly("pixels", named_rows(&FrameObject::pixels, {kJointCount, 2}, kJointNames),
                             "The same by name.")
      .def_property_readonly("angles_array", array_at(&FrameObject::angles, {kAngleCount}),
                             "Angles of the joints (20) in degrees, in the order of ANGLES.")
      .def_property_readonly("angles", named_rows(&FrameObject::angles, {kAngleCount}, kAngleNames),
                             "The same by name.")
      .def_property_readonly(
          "spread_array", &spread_of,
          "Covariance of each joint (12, 3, 3) in square millimetres, relative to the middle of the\n"
          "shoulders, in the order of JOINTS; None if the pose has none.")
      .def_property_readonly(
          "spread",
          [](const py::object& self) {
            const py::object rows = spread_of(self);
            return rows.is_none() ? rows : py::object(by_name(py::array(rows), kJointNames));
          },
          "The same by name; None if the pose has none.")
      .def_property_readonly("second_mode", of_spread(&PoseSpread::second_mode),
                             "Weight of the second-best explanation of the image, from 0 to 1; or None.")
      .def_property_readonly("effective_particles", of_spread(&PoseSpread::effective_particles),
                             "Effective number of particles; or None.")
      .def_property_readonly(
          "hands",
          [](const py::object& self) -> py::object {
            const auto& frame = self.cast<const FrameObject&>();
            if (!frame.hands) {
              return py::none();
            }
            py::dict hands;
            const HandObject &left = frame.hands->front(), &right = frame.hands->back();
            hands["left"] = py::cast(left, py::return_value_policy::reference_internal, self);
            hands["right"] = py::cast(right, py::return_value_policy::reference_internal, self);
            return hands;
          },
          "The hands as \"left\" and \"right\"; None if hands are not tracked.")
      .def_property_readonly(
          "face", [](const FrameObject& frame) { return frame.face ? &*frame.face : nullptr; },
          py::return_value_policy::reference_internal, "The face; None if none is seen.")
      .def_property_readonly(
          "region_score", [](const FrameObject& frame) { return frame.motion.region_score; },
          "F: the share of the pixels in which image and model differ.")
      .def_property_readonly(
          "contour_score", [](const FrameObject& frame) { return frame.motion.contour_score; },
          "D_C: the mean distance of the contours in pixels of the working image.")
      .def_property_readonly(
          "evaluations", [](const FrameObject& frame) { return frame.motion.evaluations; },
          "Number of poses that were scored.")
      .def_property_readonly(
          "stage_ms",
          [](const FrameObject& frame) {
            py::dict times;
            for (const auto& [stage, ms] : frame.motion.stage_ms) {
              times[stage.c_str()] = ms;
            }
            return times;
          },
          "Time of each stage in milliseconds.")
      .def("__repr__", &description);
}

}  // namespace telemime::python
