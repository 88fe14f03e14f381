// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// From now on Ctrl-C, SIGTERM and a terminal that is closed (SIGHUP, unless it is ignored, as nohup does)
/// are noted, to end in order; the second one ends the program at once: whatever hangs would be waited for
/// else.
void note_interrupts();

/// Whether one was noted.
bool interrupted();

}  // namespace telemime
