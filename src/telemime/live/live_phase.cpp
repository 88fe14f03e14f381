// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_phase.h"

#include <array>
#include <cstddef>

namespace telemime {

std::string_view to_string(LivePhase phase) {
  constexpr std::array<std::string_view, 8> kNames = {"opening",  "empty_room", "background", "person",
                                                      "tracking", "lost",       "stopped",    "ended"};
  return kNames[static_cast<std::size_t>(phase)];
}

}  // namespace telemime
