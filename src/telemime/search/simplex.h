// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace telemime {

/// Box in which a search stays. Both vectors have the size of the search space.
struct Bounds {
  Eigen::VectorXd low;
  Eigen::VectorXd high;
};

struct SimplexOptions {
  double reflection = 1.0;
  double expansion = 2.0;
  double contraction = 0.5;
  double shrink = 0.5;
  /// Converged when worst - best falls below this share of their mean magnitude.
  double tolerance = 1e-4;
  int max_evaluations = 500;
};

/// A point of the search space and its cost.
struct Vertex {
  Eigen::VectorXd point;
  double cost = 0.0;
};

enum class StopReason { converged, evaluations };

struct SimplexResult {
  std::vector<Vertex> simplex;  ///< the final one, best vertex first; n + 1 vertices
  int evaluations = 0;
  StopReason reason = StopReason::evaluations;
  const Vertex& best() const { return simplex.front(); }
};

/// The start point and one vertex along each axis, a step away: steps may be negative, and are turned around
/// where they would leave the bounds. All inside.
std::vector<Eigen::VectorXd> axis_simplex(const Eigen::VectorXd& start, const Eigen::VectorXd& steps,
                                          const Bounds& bounds);

/// The simplex shrunk or blown up about its best vertex so that its extent along no axis is below `least`:
/// the edge step starts from the region step's last simplex, which may have collapsed (thesis 3.5.4).
std::vector<Eigen::VectorXd> restart_simplex(const std::vector<Vertex>& simplex, const Eigen::VectorXd& least,
                                             const Bounds& bounds);

/// Downhill simplex (Nelder & Mead 1965; thesis 2.4.4.4 with the standard ordering) inside a box: trial
/// points are projected onto it. `start` holds n + 1 points. The number of evaluations never exceeds the
/// limit, unless the limit is below n + 1: then only that many vertices are evaluated and the best of them
/// comes back. Deterministic. Throws Error(usage) on an empty start, or sizes that do not match.
SimplexResult minimise(const std::function<double(const Eigen::VectorXd&)>& cost,
                       const std::vector<Eigen::VectorXd>& start, const Bounds& bounds,
                       const SimplexOptions& options);

}  // namespace telemime
