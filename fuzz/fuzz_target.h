// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "telemime/core/errors.h"

namespace telemime {

/// Calls `read` with the fuzzer's bytes. A refusal (Error of this kind) is right; anything else that is
/// thrown ends the program and so becomes a finding.
template <class Read>
int fuzz_one(const std::uint8_t* data, std::size_t size, const Read& read,
             ErrorKind refusal = ErrorKind::input) {
  try {
    // The fuzzer's bytes are text to the readers.
    read(std::string_view(reinterpret_cast<const char*>(data), size));
  } catch (const Error& error) {
    if (error.kind() != refusal) {
      std::abort();
    }
  }
  return 0;
}

}  // namespace telemime
