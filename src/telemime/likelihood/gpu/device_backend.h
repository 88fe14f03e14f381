// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "telemime/likelihood/backend.h"
#include "telemime/likelihood/gpu/device.h"

namespace telemime::gpu {

/// A back end that packs batches for a device and reads its counts. Its device_times() are of the last batch.
std::unique_ptr<Backend> make_device_backend(std::string_view name, std::unique_ptr<Device> device,
                                             CueTable cues = {});

}  // namespace telemime::gpu
