// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

#include <pybind11/pybind11.h>

#include <utility>

#include "telemime/outputs/all.h"
#include "telemime/outputs/numbers.h"

namespace telemime::python {
namespace {

namespace py = pybind11;

Point millimetres(const Eigen::Vector3d& metres) {
  return {metres.x() * kMillimetresPerMetre, metres.y() * kMillimetresPerMetre,
          metres.z() * kMillimetresPerMetre};
}

template <std::size_t kCount>
std::array<double, kCount> degrees(std::array<double, kCount> radians) {
  for (double& angle : radians) {
    angle *= kDegreesPerRadian;
  }
  return radians;
}

HandObject made_of(const HandMotion& motion) {
  HandObject hand{.visibility = motion.visibility,
                  .spread = motion.spread * kMillimetresPerMetre,
                  .wrist = degrees(Point{motion.wrist.twisting, motion.wrist.pivot, motion.wrist.flexion}),
                  .angles = degrees(motion.angles)};
  for (std::size_t j = 0; j < kHandJointCount; ++j) {
    hand.joints[j] = millimetres(motion.joints[j]);
  }
  return hand;
}

FaceObject made_of(const FaceMotion& motion) {
  return {.confidence = motion.confidence,
          .head = {motion.head.x(), motion.head.y(), motion.head.z(), motion.head.w()},
          .gaze = degrees(std::array<double, 2>{motion.gaze.x(), motion.gaze.y()}),
          .expressions = motion.expressions};
}

}  // namespace

FramePointer make_frame(const MotionFrame& motion, std::shared_ptr<const StreamHeader> header) {
  constexpr double kSquareMillimetres = kMillimetresPerMetre * kMillimetresPerMetre;
  auto frame = std::make_shared<FrameObject>();
  frame->motion = motion;
  frame->header = std::move(header);
  frame->root = millimetres(motion.pose.root);
  frame->angles = degrees(motion.pose.angles);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    frame->joints[j] = millimetres(motion.joints.at[j]);
    frame->pixels[j] = {motion.pixels[j].x(), motion.pixels[j].y()};
  }
  if (motion.spread) {
    frame->spread.emplace();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      for (Eigen::Index row = 0; row < 3; ++row) {
        const Eigen::Vector3d values = kSquareMillimetres * motion.spread->covariance[j].row(row).transpose();
        (*frame->spread)[j][static_cast<std::size_t>(row)] = {values.x(), values.y(), values.z()};
      }
    }
  }
  if (motion.hands) {
    frame->hands = {made_of((*motion.hands)[0]), made_of((*motion.hands)[1])};
  }
  if (motion.face) {
    frame->face = made_of(*motion.face);
  }
  return frame;
}

py::object header_dictionary(const std::shared_ptr<const StreamHeader>& header) {
  return header ? py::module_::import("json").attr("loads")(make_jsonl_encoder()->begin(*header))
                : py::none();
}

}  // namespace telemime::python
