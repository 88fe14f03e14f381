// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "telemime/outputs/encoder.h"

namespace telemime {

/// pose.jsonl: one JSON object per line, the first describes the stream (docs/formats.md). Millimetres,
/// degrees, camera frame.
std::unique_ptr<Encoder> make_jsonl_encoder();

}  // namespace telemime
