// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "telemime/live/live_session.h"

namespace telemime {

/// What a page asks for (docs/live-protocol.md, "From the page").
struct Guide {
  GuideStep step;
};
struct Recalibrate {};
struct AddOutput {
  std::string url;
};
struct SwitchOutputOff {
  std::string url;
};
struct RemoveOutput {
  std::string url;
};
struct Record {
  bool on;
};
struct Forget {
  int number;
};
struct Pictures {
  bool on;
  bool half;  ///< only every second one
};
struct Poses {
  bool on;
};
struct Drawn {
  std::int64_t frame;
  double stamp;  ///< ms
};
struct Ping {
  std::int64_t id;
};
using Command = std::variant<Guide, Recalibrate, AddOutput, SwitchOutputOff, RemoveOutput, Record, Forget,
                             Pictures, Poses, Drawn, Ping>;

/// Throws Error(usage) in words for anything that is not such a message: no JSON, unknown type, a field that
/// is missing or of the wrong type or range.
Command parse_command(std::string_view text);

}  // namespace telemime
