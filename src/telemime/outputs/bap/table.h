// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace telemime {

enum class BapKind { rotation, translation };

/// Axis of the body frame of H-Anim that a positive value turns about or moves along.
struct SignedAxis {
  int axis = 0;  ///< 0 = x (avatar's left), 1 = y (up), 2 = z (forward)
  int sign = 1;  ///< +1 or -1
};

/// One body animation parameter of MPEG-4.
struct Bap {
  int id = 0;  ///< 1 to 186
  std::string_view name;
  BapKind kind = BapKind::rotation;
  SignedAxis visage;  ///< as in the header of the Visage FBA library
  SignedAxis greta;   ///< as in the Greta platform
};

inline constexpr int kBapCount = 186;

/// All of them, by id; element 0 is id 1. The rows come from data/bap.csv.
std::span<const Bap> bap_table();

/// The parameter with this id, 1 to 186. Throws Error(usage) outside.
const Bap& bap(int id);

}  // namespace telemime
