// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/mirror.h"

#include "telemime/body/face_expression.h"

#include <utility>

namespace telemime {
namespace {

constexpr std::array<std::pair<Joint, Joint>, 4> kJointPairs = {{{Joint::l_shoulder, Joint::r_shoulder},
                                                                 {Joint::l_elbow, Joint::r_elbow},
                                                                 {Joint::l_wrist, Joint::r_wrist},
                                                                 {Joint::l_hand, Joint::r_hand}}};
constexpr std::array<std::pair<Segment, Segment>, 3> kSegmentPairs = {
    {{Segment::l_upper_arm, Segment::r_upper_arm},
     {Segment::l_forearm, Segment::r_forearm},
     {Segment::l_hand, Segment::r_hand}}};

template <class Values>
void exchange_sides(Values& values) {
  for (const auto& [left, right] : kJointPairs) {
    std::swap(values[static_cast<std::size_t>(left)], values[static_cast<std::size_t>(right)]);
  }
}

Body mirrored(const Body& body) {
  Body m = body;
  for (const auto& [left, right] : kSegmentPairs) {
    std::swap(m.shape[left], m.shape[right]);
  }
  for (std::array<double, 2>* const lengths : {&m.upper_arm_length, &m.forearm_length, &m.hand_length}) {
    std::swap((*lengths)[0], (*lengths)[1]);
  }
  std::swap(m.shoulder_from_neck[0], m.shoulder_from_neck[1]);
  for (Eigen::Vector3d* const offset : {&m.neck_from_root, &m.head_from_neck, &m.head_top_from_head,
                                        &m.shoulder_from_neck[0], &m.shoulder_from_neck[1]}) {
    offset->x() = -offset->x();
  }
  return m;
}

}  // namespace

StreamHeader mirrored(const StreamHeader& header) {
  StreamHeader m = header;
  m.body = mirrored(header.body);
  return m;
}

MotionFrame mirrored(const MotionFrame& frame, const Camera& camera) {
  MotionFrame m = frame;
  m.pose = mirrored(frame.pose);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    m.joints.at[j].x() = -frame.joints.at[j].x();
    m.pixels[j].x() = 2.0 * camera.cx - frame.pixels[j].x();
  }
  exchange_sides(m.joints.at);
  exchange_sides(m.pixels);
  if (m.face) {
    m.face = mirrored(*m.face);
  }
  if (m.hands) {
    m.hands = mirrored(*frame.hands);
  }
  if (m.spread) {
    const Eigen::DiagonalMatrix<double, 3> mirror(-1.0, 1.0, 1.0);
    for (Eigen::Matrix3d& covariance : m.spread->covariance) {
      covariance = mirror * covariance * mirror;
    }
    exchange_sides(m.spread->covariance);
  }
  return m;
}

}  // namespace telemime
