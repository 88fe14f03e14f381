// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "telemime/live/live_session.h"

namespace telemime {

/// The commands of a page (docs/live-protocol.md, "From the page").
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

/// Parses a message. Throws Error(usage) if it is not valid JSON, has an unknown type, or has a field that is
/// missing or of the wrong type or range.
Command parse_command(std::string_view text);

}  // namespace telemime
