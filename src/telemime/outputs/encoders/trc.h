// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "telemime/outputs/encoder.h"

namespace telemime {

/// motion.trc: the joints as markers for OpenSim and others in OpenSim's layout: a tab after each cell, mm, y
/// up (a joint at x, y, z of the camera frame is at x, -y, -z). The cells of a lost frame are empty.
std::unique_ptr<Encoder> make_trc_encoder();

}  // namespace telemime
