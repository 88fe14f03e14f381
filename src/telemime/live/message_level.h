// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// Severity of a message for the user: `info` is optional reading, `warning` means that results are worse
/// than they could be, `error` that something requested does not work.
enum class MessageLevel { info, warning, error };

}  // namespace telemime
