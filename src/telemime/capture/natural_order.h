// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace telemime {

/// True when `a` sorts before `b` as a person would sort file names: runs of digits compare as numbers of any
/// length ("frame2" before "frame10"), all else byte by byte. Equal numbers with fewer leading zeros come
/// first. A strict weak order.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace telemime
