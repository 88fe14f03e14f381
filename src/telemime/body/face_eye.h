// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// Radius of an eyeball, mm.
inline constexpr double kEyeball = 12.0;
/// How far an iris is before the line between the corners of its eye, mm.
inline constexpr double kIrisBulge = 4.0;

}  // namespace telemime
