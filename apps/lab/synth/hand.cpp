// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/avatar.h"

namespace telemime {
namespace {

using Eigen::Vector3f;

struct FingerRest {
  Vector3f wrist_end, knuckle;
  std::array<float, 3> phalanges;
  float radius;
  float spread;  // rad, toward the thumb
};

}  // namespace

HandShape hand_shape(const FingerCurls& curl) {
  // Lengths after the hand of an adult of average size; the fingers shrink toward the tips.
  const std::array<FingerRest, 4> rest = {{
      {{0.014f, 0.012f, 0.0f}, {0.028f, 0.090f, 0.001f}, {0.040f, 0.024f, 0.018f}, 0.0088f, 0.13f},
      {{0.005f, 0.012f, 0.002f}, {0.008f, kHandKnuckle, 0.003f}, {0.044f, 0.028f, 0.019f}, 0.0090f, 0.03f},
      {{-0.005f, 0.012f, 0.002f}, {-0.011f, 0.088f, 0.002f}, {0.041f, 0.026f, 0.019f}, 0.0085f, -0.07f},
      {{-0.013f, 0.012f, 0.0f}, {-0.028f, 0.080f, -0.001f}, {0.032f, 0.020f, 0.017f}, 0.0076f, -0.20f},
  }};
  HandShape hand;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const auto bend = static_cast<float>(curl[i]);
    const FingerRest& f = rest[i];
    hand.palm[i] = round_cone(f.wrist_end, f.knuckle, 0.0165f, 0.0118f);
    Vector3f at = f.knuckle;
    float angle = 0.0f;
    const std::array<float, 3> share = {1.15f, 1.40f, 0.9f};
    for (std::size_t j = 0; j < 3; ++j) {
      angle += bend * share[j] * (1.0f + 0.06f * static_cast<float>(i));
      // Fingers spread less the more they bend.
      const float spread = f.spread * (1.0f - 0.7f * bend);
      const Vector3f direction(std::sin(spread) * std::cos(angle), std::cos(spread) * std::cos(angle),
                               -std::sin(angle));
      const Vector3f next = at + direction * f.phalanges[j];
      const float thick = f.radius * (1.0f - 0.09f * static_cast<float>(j));
      hand.fingers[i][j] = round_cone(at, next, thick, thick * 0.90f);
      at = next;
    }
  }
  const auto bend = static_cast<float>(curl[4]);
  hand.palm[4] = round_cone({0.014f, 0.018f, -0.006f}, {0.032f, 0.048f, -0.010f}, 0.0160f, 0.0125f);
  const Vector3f base(0.034f, 0.050f, -0.010f);
  const Vector3f middle = base + Vector3f(0.022f - 0.010f * bend, 0.024f, -0.008f - 0.014f * bend);
  const Vector3f tip = middle + Vector3f(0.010f - 0.016f * bend, 0.023f, -0.006f - 0.008f * bend);
  hand.thumb[0] = round_cone(base, middle, 0.0115f, 0.0102f);
  hand.thumb[1] = round_cone(middle, tip, 0.0100f, 0.0080f);
  return hand;
}

std::array<Vector3f, 21> hand_joints(const HandShape& hand) {
  std::array<Vector3f, 21> joints;
  joints[0].setZero();
  joints[1] = hand.palm[4].a;
  joints[2] = hand.thumb[0].a;
  joints[3] = hand.thumb[1].a;
  joints[4] = hand.thumb[1].a + hand.thumb[1].ba;
  for (std::size_t f = 0; f < hand.fingers.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      joints[5 + 4 * f + i] = hand.fingers[f][i].a;
    }
    joints[8 + 4 * f] = hand.fingers[f][2].a + hand.fingers[f][2].ba;
  }
  return joints;
}

float distance(const HandShape& hand, const Vector3f& p) {
  float palm = distance(hand.palm[0], p);
  for (std::size_t i = 1; i < hand.palm.size(); ++i) {
    palm = smooth_union(palm, distance(hand.palm[i], p), 0.016f);
  }
  float d = palm;
  for (const auto& finger : hand.fingers) {
    // A finger of its own, joined to the palm but never to its neighbour.
    const float whole = smooth_union(smooth_union(distance(finger[0], p), distance(finger[1], p), 0.003f),
                                     distance(finger[2], p), 0.003f);
    d = std::min(d, smooth_union(palm, whole, 0.007f));
  }
  const float thumb = smooth_union(distance(hand.thumb[0], p), distance(hand.thumb[1], p), 0.004f);
  return std::min(d, smooth_union(palm, thumb, 0.012f));
}

}  // namespace telemime
