// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <atomic>
#include <memory>
#include <ostream>

/// The subcommands of the program, in the order of its help.
namespace telemime {

/// Whether a thread still hangs in a driver or FFmpeg (LiveOptions::left_behind).
using LeftBehind = std::shared_ptr<std::atomic<bool>>;

/// Adds `telemime live`: from the webcam to an avatar, on a page and in other programs. If `left_behind` is
/// set afterwards, the program must exit without running the destructors of static objects.
void add_live_command(CLI::App& app, const LeftBehind& left_behind);

/// Adds `telemime track INPUT [options]`.
void add_track_command(CLI::App& app);

/// Adds `telemime calibrate INPUT --out FILE [options]`.
void add_calibrate_command(CLI::App& app);

/// Adds `telemime evaluate POSE --truth truth.json [--json FILE]`. When it is called, it prints a table on
/// the standard output and writes the JSON file; it throws Error(input), Error(output) or Error(usage).
void add_evaluate_command(CLI::App& app);

/// Adds `telemime avatar`: writes one of the project's own avatars as a VRM file.
void add_avatar_command(CLI::App& app);

/// Adds `telemime doctor`: looks at this computer and says what to do where something is missing.
void add_doctor_command(CLI::App& app);

/// Prints what can be done here: the camera that was found, and the first commands to try.
void print_first_steps(std::ostream& out);

/// Adds `telemime config`: prints the effective settings, or explains them.
void add_config_command(CLI::App& app);

}  // namespace telemime
