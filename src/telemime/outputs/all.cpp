// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/all.h"

#include "telemime/core/errors.h"
#include "telemime/core/text.h"

namespace telemime {

const OutputFormat& output_format(std::string_view name) {
  for (const OutputFormat& format : kOutputFormats) {
    if (format.name == name) {
      return format;
    }
  }
  throw Error(ErrorKind::usage, "there is no output format \"" + std::string(name) + "\"",
              "use one of " + joined(kOutputFormats, &OutputFormat::name));
}

}  // namespace telemime
