// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace telemime {

/// Bounds of a search space; both vectors have its dimension.
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

/// n + 1 points inside the bounds: the start and one vertex one step away along each axis. Steps may be
/// negative; a step that would leave the bounds is reversed.
std::vector<Eigen::VectorXd> axis_simplex(const Eigen::VectorXd& start, const Eigen::VectorXd& steps,
                                          const Bounds& bounds);

/// Points of the simplex for a second search, with an extent of at least `least` along every axis: the edge
/// step starts from the region step's last simplex, which may have collapsed (thesis 3.5.4).
std::vector<Eigen::VectorXd> restart_simplex(const std::vector<Vertex>& simplex, const Eigen::VectorXd& least,
                                             const Bounds& bounds);

/// Downhill simplex (Nelder & Mead 1965; thesis 2.4.4.4 with the standard ordering) inside bounds, onto which
/// trial points are projected. `start` holds n + 1 points. Evaluations never exceed the limit; with a limit
/// below n + 1 only that many vertices are evaluated and the best is returned. Deterministic. Throws
/// Error(usage) for an empty start and for sizes that do not match.
SimplexResult minimise(const std::function<double(const Eigen::VectorXd&)>& cost,
                       const std::vector<Eigen::VectorXd>& start, const Bounds& bounds,
                       const SimplexOptions& options);

}  // namespace telemime
