// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

namespace telemime {

inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
inline constexpr double kMillimetresPerMetre = 1000.0;

/// `value` rounded to a multiple of 10^-decimals, never -0. Its shortest representation has at most that many
/// decimals.
inline double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale + 0.0;
}

/// Appends a finite `value` in fixed notation, independent of the locale.
void append_fixed(std::string& text, double value, int decimals);

/// `count` and spaces up to `width` characters, for a field that is patched later. The number is first: many
/// readers take what follows "Frames: " for it. Throws Error(output) when it does not fit.
std::string padded_count(std::size_t count, std::size_t width);

}  // namespace telemime
