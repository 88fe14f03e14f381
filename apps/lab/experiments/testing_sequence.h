// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/sequence.h"
#include "telemime/evaluation/frame_errors.h"

namespace telemime::testing {

/// Three typical poses of the model itself at 80x60, drawn without noise; starts at the first.
inline PreparedSequence model_sequence() {
  PreparedSequence sequence;
  sequence.name = "model";
  sequence.camera = Camera{}.scaled_to(80, 60);
  sequence.model = make_model(Shape{});
  sequence.limits = anatomical_limits();
  sequence.truth.camera = sequence.camera;
  Random random(4);
  for (const Pose& pose : typical_poses(3, random)) {
    sequence.frames.push_back(frame_of_model(sequence.model, pose, sequence.camera));
    const JointPositions joints = forward_kinematics(sequence.model.body, pose).joints;
    sequence.truth.frames.push_back(as_truth(joints));
    sequence.start = sequence.frames.size() == 1 ? pose : sequence.start;
  }
  return sequence;
}

}  // namespace telemime::testing
