// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "telemime/search/blocks.h"
#include "telemime/tracking/context.h"
#include "telemime/tracking/parts.h"

namespace telemime {

/// Some of the pose's numbers as a space to search and to sample.
struct SearchSpace {
  SearchBlock block;  ///< its steps are the standard deviations of the diffusion
  /// The pose of a point; none when a wrist is out of reach.
  std::function<std::optional<Pose>(const Eigen::VectorXd&)> within_reach;
};

/// Space of the numbers of these parts: joint angles, or with `end_effector` for the arms the wrist on its
/// viewing ray and the swivel angle (thesis 4.4.2.3). The other parts keep their values in `pose`.
SearchSpace search_space(const FilterContext& context, const Pose& pose, const PartSet& parts,
                         bool end_effector);

/// A pose drawn about the start (thesis equation 4.13). One outside the limits or out of reach is drawn
/// again; after ten draws the start is returned.
Pose diffused(const FilterContext& context, const SearchSpace& space, Random& random);

}  // namespace telemime
