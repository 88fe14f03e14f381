// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/bap/table.h"

#include <string>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr SignedAxis axis(std::string_view text) {
  return {text[1] - 'X', text[0] == '-' ? -1 : 1};
}

constexpr std::array<Bap, kBapCount> kTable = {{
#include "bap_rows.inc"
}};

}  // namespace

std::span<const Bap> bap_table() {
  return kTable;
}

const Bap& bap(int id) {
  if (id < 1 || id > kBapCount) {
    throw Error(ErrorKind::usage, "there is no body animation parameter " + std::to_string(id),
                "ids are 1 to 186");
  }
  return kTable[static_cast<std::size_t>(id - 1)];
}

}  // namespace telemime
