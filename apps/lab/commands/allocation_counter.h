// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace telemime {

/// How often this program, its libraries included, has called operator new so far, on all threads. OpenCV's
/// images and what C code takes do not come this way. Nothing in builds with sanitizers: they have an
/// operator new of their own.
std::optional<std::uint64_t> heap_allocations();

}  // namespace telemime
