// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// How much words for the user matter: `info` can be left unread; after a `warning` something is worse than
/// it could be; after an `error` something that was asked for does not work.
enum class MessageLevel { info, warning, error };

}  // namespace telemime
