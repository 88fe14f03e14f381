// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/bap/fingers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "telemime/body/rotations.h"

namespace telemime {
namespace {

// The left flexion of each finger's first joint, in the order of the hand model. The right one follows it,
// then the pairs of pivot, twisting, and the flexions of the second and third joint.
constexpr std::array<int, kFingerCount> kFirst = {171, 161, 149, 137, 125};
constexpr int kPerJoint = 2;

int id_of(Side side, std::size_t finger, int parameter) {
  return kFirst[finger] + kPerJoint * parameter + static_cast<int>(side);
}

std::size_t place(int id) {
  const auto& ids = finger_bap_ids();
  return static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
}

// The player's axes from those of a hanging hand whose palm faces the thigh.
Eigen::Matrix3d player_from_hand(const BapProfile& profile, Side side) {
  const double quarter = side == Side::left ? std::numbers::pi / 2.0 : -std::numbers::pi / 2.0;
  return profile.palms_forward ? rotation_y(quarter) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

}  // namespace

const std::array<int, kFingerBapCount>& finger_bap_ids() {
  static const auto ids = [] {
    std::array<int, kFingerBapCount> all{};
    auto next = all.begin();
    for (std::size_t f = 0; f < kFingerCount; ++f) {
      for (int parameter = 0; parameter < 5; ++parameter) {
        *next++ = id_of(Side::left, f, parameter);
        *next++ = id_of(Side::right, f, parameter);
      }
    }
    std::sort(all.begin(), all.end());
    return all;
  }();
  return ids;
}

FingerBapValues encode_bap_fingers(const BapProfile& profile, const HandMotions& hands,
                                   const FingerBapValues& last) {
  FingerBapValues values{};
  const auto unit = [&](int id) { return profile.units_per_radian * (bap(id).*profile.sign).sign; };
  for (const Side side : {Side::left, Side::right}) {
    const Eigen::Matrix3d turn = player_from_hand(profile, side);
    const auto rotations = finger_rotations(hands[static_cast<std::size_t>(side)].angles, side);
    for (std::size_t f = 0; f < kFingerCount; ++f) {
      // Flexion, pivot and twisting of the first joint, each about its axis.
      std::array<int, 3> id_about{};
      for (int parameter = 0; parameter < 3; ++parameter) {
        const int id = id_of(side, f, parameter);
        id_about.at(static_cast<std::size_t>((bap(id).*profile.sign).axis)) = id;
      }
      EulerAngles near{};
      for (std::size_t i = 0; i < 3; ++i) {
        const int id = id_about.at(static_cast<std::size_t>(profile.finger_order[i]));
        near[i] = last[place(id)] / unit(id);
      }
      const EulerAngles angles =
          decompose(turn * rotations[f][0] * turn.transpose(), profile.finger_order, near);
      for (std::size_t i = 0; i < 3; ++i) {
        const int id = id_about.at(static_cast<std::size_t>(profile.finger_order[i]));
        values[place(id)] = static_cast<int>(std::lround(angles[i] * unit(id)));
      }
      for (std::size_t joint = 1; joint < 3; ++joint) {
        const int id = id_of(side, f, static_cast<int>(joint) + 2);
        const Eigen::AngleAxisd bend(Eigen::Matrix3d(turn * rotations[f][joint] * turn.transpose()));
        const double angle = std::copysign(bend.angle(), bend.axis()[(bap(id).*profile.sign).axis]);
        values[place(id)] = static_cast<int>(std::lround(angle * unit(id)));
      }
    }
  }
  return values;
}

}  // namespace telemime
