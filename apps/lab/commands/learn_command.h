// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// Adds `telemime learn FOLDER... --out FILE`: estimates the particle filter's numbers from sequences with
/// truth.
void add_learn_command(CLI::App& app);

}  // namespace telemime
