// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/hand_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace telemime {
namespace {

using Eigen::Vector3d;

// Standard deviations, learned on synthetic hands.
constexpr double kAcross = 0.008;  // m, of a point in the picture
constexpr double kDepth = 0.024;   // m
constexpr double kTilt = 0.5;      // m in depth for each m across
constexpr double kSize = 0.1;      // of the palm, as a logarithm
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kBend = 35.0 * kDegree;      // from rest
constexpr double kSpread = 6.0 * kDegree;     // of a finger to the side
constexpr double kTogether = 25.0 * kDegree;  // between neighbouring fingers
const Vector3d kPlace(0.02, 0.02, 0.03);      // m, of the wrist

// What is sought: turn of the palm (a small rotation), angles, place of the wrist, size, two tilts.
constexpr Eigen::Index kTurnAt = 0, kAnglesAt = 3, kPlaceAt = 19, kSizeAt = 22, kTiltAt = 23, kUnknowns = 25;
constexpr std::size_t kPairs = 3;  // of neighbouring fingers
constexpr Eigen::Index kPointRows = 3 * kHandJointCount, kPriorRows = 16 + 2 * kPairs + 3 + 1 + 2;
using Residuals = Eigen::Matrix<double, kPointRows + kPriorRows, 1>;
using Slopes = Eigen::Matrix<double, kPointRows + kPriorRows, kUnknowns>;
using Step = Eigen::Matrix<double, kUnknowns, 1>;

struct State {
  Eigen::Matrix3d turn;
  HandAngles angles = resting_hand();
  Vector3d place = Vector3d::Zero();
  double size = 0.0;
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();
};

HandPoints model_points(const HandSizes& sizes, const State& state, Side side) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear() = std::exp(state.size) * state.turn;
  frame.translation() = state.place;
  return hand_points(sizes, state.angles, side, frame);
}

bool is_spread(std::size_t angle) {
  return angle == 1 || (angle >= 4 && (angle - 4) % 3 == 1);
}

Residuals residuals(const HandSizes& sizes, const HandPoints& points, Side side, const State& state) {
  Residuals r;
  // Points: where the network saw them, without the tilt.
  const HandPoints model = model_points(sizes, state, side);
  for (std::size_t i = 0; i < kHandJointCount; ++i) {
    Vector3d off = points[i] - model[i];
    off.z() -= state.tilt.dot(points[i].head<2>());
    r.segment<3>(static_cast<Eigen::Index>(3 * i)) = off.cwiseQuotient(Vector3d(kAcross, kAcross, kDepth));
  }
  // Angles: from rest, and of neighbouring fingers from each other.
  static const HandAngles rest = resting_hand();
  HandAngles off{};
  Eigen::Index row = kPointRows;
  for (std::size_t a = 0; a < kHandAngleCount; ++a) {
    off[a] = state.angles[a] - rest[a];
    r[row++] = off[a] / (is_spread(a) ? kSpread : kBend);
  }
  for (std::size_t f = 1; f <= kPairs; ++f) {
    for (const std::size_t joint : {0U, 2U}) {
      r[row++] = (off[kFirstFingerAngle[f] + joint] - off[kFirstFingerAngle[f + 1] + joint]) / kTogether;
    }
  }
  // Place, size and tilt.
  r.segment<3>(row) = state.place.cwiseQuotient(kPlace);
  r[row + 3] = state.size / kSize;
  r.tail<2>() = state.tilt / kTilt;
  return r;
}

State moved(const State& state, const Step& step) {
  State next = state;
  const Vector3d turn = step.segment<3>(kTurnAt);
  if (turn.norm() > 0.0) {
    next.turn = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * state.turn;
  }
  for (std::size_t a = 0; a < kHandAngleCount; ++a) {
    const AngleRange& range = hand_limits()[a];
    next.angles[a] =
        std::clamp(state.angles[a] + step[kAnglesAt + static_cast<Eigen::Index>(a)], range.min, range.max);
  }
  next.place += step.segment<3>(kPlaceAt);
  next.size += step[kSizeAt];
  next.tilt += step.tail<2>();
  return next;
}

}  // namespace

std::optional<HandFit> likeliest_hand(const HandSizes& sizes, const HandPoints& points, Side side) {
  constexpr int kSteps = 6;
  constexpr double kDelta = 1e-5;
  constexpr double kLargest = 0.5;  // step
  constexpr double kEnough = 1e-3;  // share of the cost by which a step must lower it
  // From the turn of the palm and a hand at rest.
  const auto turn = palm_rotation(sizes, points, side);
  if (!turn) {
    return std::nullopt;
  }
  State state{.turn = *turn};
  Residuals r = residuals(sizes, points, side, state);
  double cost = r.squaredNorm();
  double damping = 1e-3;
  for (int i = 0; i < kSteps; ++i) {
    // The slopes of the residuals, by differences.
    Slopes slopes;
    for (Eigen::Index k = 0; k < kUnknowns; ++k) {
      // Away from the nearer limit.
      double delta = kDelta;
      if (k >= kAnglesAt && k < kPlaceAt) {
        const auto a = static_cast<std::size_t>(k - kAnglesAt);
        delta = state.angles[a] + kDelta > hand_limits()[a].max ? -kDelta : kDelta;
      }
      slopes.col(k) = (residuals(sizes, points, side, moved(state, delta * Step::Unit(k))) - r) / delta;
    }
    const Eigen::Matrix<double, kUnknowns, kUnknowns> normal = slopes.transpose() * slopes;
    const Step down = -slopes.transpose() * r;
    // A step that lowers the cost: more damping makes it shorter.
    const double before = cost;
    for (int tries = 0; tries < 4 && cost == before; ++tries, damping *= 8.0) {
      Eigen::Matrix<double, kUnknowns, kUnknowns> damped = normal;
      damped.diagonal() *= 1.0 + damping;
      const Step step = damped.ldlt().solve(down).cwiseMax(-kLargest).cwiseMin(kLargest);
      const State next = moved(state, step);
      const Residuals better = residuals(sizes, points, side, next);
      if (better.squaredNorm() < cost) {
        state = next;
        r = better;
        cost = better.squaredNorm();
        damping /= 64.0;
      }
    }
    if (!(before - cost > kEnough * cost)) {
      break;
    }
  }
  return HandFit{.frame_from_hand = state.turn,
                 .angles = state.angles,
                 .scale = std::exp(state.size),
                 .error = kAcross * std::sqrt(r.head<kPointRows>().squaredNorm() / kHandJointCount),
                 .cost = cost};
}

}  // namespace telemime
