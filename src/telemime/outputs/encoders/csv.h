// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "telemime/outputs/encoder.h"

namespace telemime {

/// pose.csv: one line per frame for spreadsheets, after a line with the names of the columns
/// (docs/formats.md). Millimetres, degrees, camera frame.
std::unique_ptr<Encoder> make_csv_encoder();

}  // namespace telemime
