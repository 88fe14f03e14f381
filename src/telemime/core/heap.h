// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// Gives the free memory of the heap back to the system. To be called when much was freed that is not soon
/// asked for again: each thread's share of the GNU heap keeps what it held at most, so that a program which
/// runs for hours holds the sum of all its peaks. A millisecond or so, during which others' allocations wait.
/// False where there was nothing to give, and with other C libraries, where nothing is done.
bool give_heap_back();

}  // namespace telemime
