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

constexpr int kOldFirstFinger = 48;
constexpr int kOldFirstSpine = 98;
constexpr int kOldLast = 169;
constexpr int kOldSpineMinusNew = 47;

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

std::optional<int> bap_id_from_old(int old_id) {
  if (old_id >= 1 && old_id < kOldFirstFinger) {
    return old_id;
  }
  if (old_id >= kOldFirstSpine && old_id <= kOldLast) {
    return old_id - kOldSpineMinusNew;
  }
  return std::nullopt;
}

}  // namespace telemime
