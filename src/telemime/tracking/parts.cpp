// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/parts.h"

namespace telemime {

Part part_of_number(std::size_t index) {
  if (index < 6) {
    return Part::trunk;
  }
  if (index < 9) {
    return Part::head;
  }
  switch (static_cast<Angle>(index - 3)) {
    case Angle::l_shoulder_flexion:
    case Angle::l_shoulder_twisting:
    case Angle::l_shoulder_abduct:
    case Angle::l_elbow_flexion:
    case Angle::l_wrist_flexion:
    case Angle::l_wrist_twisting:
    case Angle::l_wrist_pivot:
      return Part::left_arm;
    default:
      return Part::right_arm;
  }
}

std::vector<std::size_t> numbers_of(const PartSet& parts) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < kPoseSize; ++i) {
    if (has(parts, part_of_number(i))) {
      numbers.push_back(i);
    }
  }
  return numbers;
}

Part part_of_segment(Segment segment) {
  switch (segment) {
    case Segment::chest:
      return Part::trunk;
    case Segment::head:
      return Part::head;
    case Segment::l_upper_arm:
    case Segment::l_forearm:
    case Segment::l_hand:
      return Part::left_arm;
    default:
      return Part::right_arm;
  }
}

}  // namespace telemime
