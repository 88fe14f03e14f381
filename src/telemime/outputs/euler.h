// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace telemime {

/// Axes of a product of three rotations, 0 = x, 1 = y, 2 = z, outermost (leftmost) first; all different.
using AxisOrder = std::array<int, 3>;

/// Angles of R = R_a(angles[0]) R_b(angles[1]) R_c(angles[2]) for order {a, b, c}, rad, right-hand rule.
using EulerAngles = std::array<double, 3>;

Eigen::Matrix3d compose(const AxisOrder& order, const EulerAngles& angles);

/// The angles of a rotation, each in (-pi, pi]; of the two solutions, the one nearer to `near`. If the middle
/// angle is +-90 degrees, only the sum or difference of the other two is determined; the innermost then keeps
/// its value of `near`.
EulerAngles decompose(const Eigen::Matrix3d& rotation, const AxisOrder& order, const EulerAngles& near);

}  // namespace telemime
