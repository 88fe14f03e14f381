// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/search_space.h"

#include <algorithm>

#include "telemime/body/arm_parts.h"
#include "telemime/body/rotations.h"

namespace telemime {
namespace {

// Layout of a space: plain pose numbers, then seven numbers for each arm in end-effector space.
struct Layout {
  std::vector<std::size_t> numbers;
  std::vector<Side> arms;
};

Layout layout_of(const PartSet& parts, bool end_effector) {
  Layout layout;
  if (!end_effector) {
    layout.numbers = numbers_of(parts);
    return layout;
  }
  PartSet trunk = parts;
  for (const Side side : {Side::left, Side::right}) {
    const Part arm = side == Side::left ? Part::left_arm : Part::right_arm;
    if (has(parts, arm)) {
      layout.arms.push_back(side);
      trunk.reset(static_cast<std::size_t>(arm));
    }
  }
  layout.numbers = numbers_of(trunk);
  return layout;
}

}  // namespace

SearchSpace search_space(const FilterContext& context, const Pose& pose, const PartSet& parts,
                         bool end_effector) {
  const Body& body = context.model.body;
  const JointLimits& limits = context.limits;
  const Layout layout = layout_of(parts, end_effector);
  const auto plain = static_cast<Eigen::Index>(layout.numbers.size());
  const Eigen::Index n = plain + 7 * static_cast<Eigen::Index>(layout.arms.size());
  SearchSpace result;
  SearchBlock& space = result.block;
  space.start.resize(n);
  space.steps.resize(n);
  space.bounds = {Eigen::VectorXd(n), Eigen::VectorXd(n)};
  // Plain numbers: diffusion as learned (equation 4.13), bounds from the joint limits.
  const PoseVector all = pose.vector();
  for (Eigen::Index i = 0; i < plain; ++i) {
    const std::size_t k = layout.numbers[static_cast<std::size_t>(i)];
    const bool angle = k >= 3;
    space.start[i] = all[static_cast<Eigen::Index>(k)];
    space.steps[i] = context.numbers.change[static_cast<Eigen::Index>(k)];
    space.bounds.low[i] = angle ? limits.min[k - 3] : k == 2 ? kNearestSearched : -kMostAsideSearched;
    space.bounds.high[i] = angle ? limits.max[k - 3] : k == 2 ? kFarthestSearched : kMostAsideSearched;
  }
  // Arms in end-effector space: steps in pixels across the viewing ray, in metres along it.
  for (std::size_t a = 0; a < layout.arms.size(); ++a) {
    const Eigen::Index at = plain + 7 * static_cast<Eigen::Index>(a);
    const SearchBlock arm = arm_block(body, pose, layout.arms[a], limits, 1.0);
    space.start.segment<7>(at) = arm.start;
    space.bounds.low.segment<7>(at) = arm.bounds.low;
    space.bounds.high.segment<7>(at) = arm.bounds.high;
    const double z = arm.start[2];
    space.steps.segment<4>(at) << context.numbers.wrist_across / z, context.numbers.wrist_across / z,
        context.numbers.wrist_along, context.numbers.swivel;
    Eigen::Index hand = at + 4;
    for (const Angle angle : arm_parts(layout.arms[a]).wrist_angles()) {
      space.steps[hand++] = context.numbers.change[3 + static_cast<Eigen::Index>(angle)];
    }
  }
  space.steps *= context.config.diffusion;
  // From points back to poses: clamped to what is in reach, or only if it is in reach.
  const auto moved = [all, layout, plain](const Eigen::VectorXd& x) {
    PoseVector numbers = all;
    for (Eigen::Index i = 0; i < plain; ++i) {
      numbers[static_cast<Eigen::Index>(layout.numbers[static_cast<std::size_t>(i)])] = x[i];
    }
    return Pose::from_vector(numbers);
  };
  const auto arm_of = [plain](const Eigen::VectorXd& x, std::size_t a) -> Eigen::VectorXd {
    return x.segment<7>(plain + 7 * static_cast<Eigen::Index>(a));
  };
  space.decode = [&body, &limits, layout, moved, arm_of](const Eigen::VectorXd& x) {
    Pose to = moved(x);
    for (std::size_t a = 0; a < layout.arms.size(); ++a) {
      to = with_arm(body, to, layout.arms[a], arm_of(x, a), limits);
    }
    return to;
  };
  result.within_reach = [&body, &limits, layout, moved,
                         arm_of](const Eigen::VectorXd& x) -> std::optional<Pose> {
    Pose to = moved(x);
    for (std::size_t a = 0; a < layout.arms.size(); ++a) {
      const Eigen::VectorXd arm = arm_of(x, a);
      const ArmTarget wanted = {Eigen::Vector3d(arm[0] * arm[2], arm[1] * arm[2], arm[2]),
                                wrap_angle(arm[3])};
      const auto angles = solve_arm(body, to, layout.arms[a], wanted, limits);
      if (!angles) {
        return std::nullopt;
      }
      set_arm_angles(to, layout.arms[a], *angles);
      const auto hand = arm_parts(layout.arms[a]).wrist_angles();
      for (std::size_t i = 0; i < hand.size(); ++i) {
        to[hand[i]] = arm[static_cast<Eigen::Index>(4 + i)];
      }
    }
    return to;
  };
  return result;
}

Pose diffused(const FilterContext& context, const SearchSpace& space, Random& random) {
  constexpr int kTries = 10;
  constexpr double kSlack = 1e-6;
  const SearchBlock& block = space.block;
  Eigen::VectorXd x(block.start.size());
  for (int attempt = 0; attempt < kTries; ++attempt) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      // Each number that leaves its range is drawn again by itself.
      for (int again = 0; again < kTries; ++again) {
        x[i] = random.normal(block.start[i], block.steps[i]);
        if (x[i] >= block.bounds.low[i] && x[i] <= block.bounds.high[i]) {
          break;
        }
      }
      x[i] = std::clamp(x[i], block.bounds.low[i], block.bounds.high[i]);
    }
    const std::optional<Pose> pose = space.within_reach(x);
    if (pose && context.limits.contains(*pose, kSlack)) {
      return context.limits.clamp(*pose);
    }
  }
  return context.limits.clamp(block.decode(block.start));
}

}  // namespace telemime
