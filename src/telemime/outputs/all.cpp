// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/all.h"

#include "telemime/core/errors.h"

namespace telemime {

const OutputFormat& output_format(std::string_view name) {
  std::string names;
  for (const OutputFormat& format : kOutputFormats) {
    if (format.name == name) {
      return format;
    }
    names += (names.empty() ? "" : ", ") + std::string(format.name);
  }
  throw Error(ErrorKind::usage, "there is no output format \"" + std::string(name) + "\"",
              "use one of " + names);
}

}  // namespace telemime
