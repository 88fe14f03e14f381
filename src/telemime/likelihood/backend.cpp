// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/backend.h"

#include "telemime/core/errors.h"

namespace telemime {

void Backend::evaluate(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
                       Reduction terms, std::span<Score> scores, std::span<const Kinematics> kinematics) {
  if (poses.size() != scores.size() || (!kinematics.empty() && kinematics.size() != poses.size())) {
    throw Error(ErrorKind::usage, "evaluate: as many scores, and kinematics if any, as poses are needed");
  }
  counts_.assign(poses.size(), {});
  if (terms != Reduction::none) {
    count(frame, model, poses, kinematics, terms, counts_);
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (wants(terms, Reduction::overlap)) {
      counts_[i].observed = frame.observed;
    }
    const CueInput input{.frame = frame,
                         .model = model,
                         .reductions = counts_[i],
                         .kinematics = kinematics.empty() ? nullptr : &kinematics[i]};
    scores[i] = {cue_costs(cues_, input, poses[i], terms), counts_[i]};
  }
}

}  // namespace telemime
