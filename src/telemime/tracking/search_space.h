// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "telemime/search/blocks.h"
#include "telemime/tracking/context.h"
#include "telemime/tracking/parts.h"

namespace telemime {

/// Numbers of the pose as a space to search and to draw from.
struct SearchSpace {
  SearchBlock block;  ///< its steps are the standard deviations of the diffusion, with its scale
  /// The pose of a point; nothing where a wrist is out of reach.
  std::function<std::optional<Pose>(const Eigen::VectorXd&)> within_reach;
};

/// The numbers of these parts: joint angles, or for the arms the wrist on its viewing ray and the swivel
/// angle (thesis 4.4.2.3). Parts that do not move stay as they are.
SearchSpace search_space(const FilterContext& context, const Pose& pose, const PartSet& parts,
                         bool end_effector);

/// A point drawn about the start (equation 4.13). Outside the limits or out of reach: drawn again; after ten
/// times the start itself.
Pose diffused(const FilterContext& context, const SearchSpace& space, Random& random);

}  // namespace telemime
