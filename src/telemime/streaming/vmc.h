// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"

namespace telemime {

/// Where VMC's "Marionette" listens (the protocol's default).
inline constexpr std::uint16_t kMarionettePort = 39539;

/// vmc://host[:39539][?bundle=1|0][&positions=all|hips][&root=still|moves]: the VMC protocol by UDP
/// (vmc_messages.h). UDP has no connection: that nobody listens is known only where the system reports it, on
/// this computer always. Throws Error(usage).
std::unique_ptr<Sender> make_vmc_sender(const SendUrl& url);

}  // namespace telemime
