// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <atomic>
#include <memory>

namespace telemime {

/// Whether a thread was left behind within a driver or FFmpeg (LiveOptions::left_behind).
using LeftBehind = std::shared_ptr<std::atomic<bool>>;

/// `telemime live`: from the webcam to an avatar, on a page and in other programs. When `left_behind` is set
/// afterwards, the program must end without the destructors of static objects.
void add_live_command(CLI::App& app, const LeftBehind& left_behind);

}  // namespace telemime
