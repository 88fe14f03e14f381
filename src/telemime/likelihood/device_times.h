// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// Where the time of a batch on a device went, s.
struct DeviceTimes {
  double upload = 0.0;    ///< poses, frame and model to the device
  double kernel = 0.0;    ///< counting there
  double download = 0.0;  ///< counts back
};

}  // namespace telemime
