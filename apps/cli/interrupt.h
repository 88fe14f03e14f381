// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// From now on Ctrl-C, SIGTERM and SIGHUP (a closed terminal, unless ignored as by nohup) request an orderly
/// end. A second one ends the program at once, in case something hangs.
void note_interrupts();

/// Whether the end was requested.
bool interrupted();

}  // namespace telemime
