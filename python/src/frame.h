// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "telemime/body/motion_frame.h"
#include "telemime/outputs/encoder.h"

/// The Python module: what it shows of the library.
namespace telemime::python {

using Point = std::array<double, 3>;

/// A hand in the units of files: mm and degrees.
struct HandObject {
  double visibility = 0.0;
  double spread = 0.0;
  Point wrist{};
  std::array<double, kHandAngleCount> angles{};
  std::array<Point, kHandJointCount> joints{};
};

/// A face in the units of files.
struct FaceObject {
  double confidence = 0.0;
  std::array<double, 4> head{};  ///< x, y, z, w
  std::array<double, 2> gaze{};
  std::array<double, kExpressionCount> expressions{};
};

/// A motion frame in the units of files, which the arrays of Python look into.
struct FrameObject {
  MotionFrame motion;
  std::shared_ptr<const StreamHeader> header;  ///< null until a person is calibrated
  Point root{};
  std::array<double, kAngleCount> angles{};
  std::array<Point, kJointCount> joints{};
  std::array<std::array<double, 2>, kJointCount> pixels{};
  std::optional<std::array<std::array<Point, 3>, kJointCount>> spread;
  std::optional<std::array<HandObject, 2>> hands;
  std::optional<FaceObject> face;
};
using FramePointer = std::shared_ptr<FrameObject>;

FramePointer make_frame(const MotionFrame& motion, std::shared_ptr<const StreamHeader> header);

/// The first line of pose.jsonl as a dictionary; None for null.
pybind11::object header_dictionary(const std::shared_ptr<const StreamHeader>& header);

void bind_frames(pybind11::module_& module);

}  // namespace telemime::python
