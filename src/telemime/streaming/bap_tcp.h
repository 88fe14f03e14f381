// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"

namespace telemime {

/// bap+tcp://host:port[?profile=iso|greta|vreng-3.1|vreng-3.2]: connects by TCP and writes what a file
/// motion.bap holds (outputs/encoders/bap.h), without end: the header with 0 frames once for each connection,
/// then two lines a frame. Frames in which the person is lost repeat the last pose, as in the file. Throws
/// Error(usage).
std::unique_ptr<Sender> make_bap_tcp_sender(const SendUrl& url);

}  // namespace telemime
