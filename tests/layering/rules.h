// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace telemime::layering {

/// Room -> every module that it may include: itself, the DEPENDS of its CMakeLists.txt, theirs, and so on.
using Reach = std::map<std::string, std::set<std::string>>;

/// What is broken, one sentence for each place: "src/telemime/a/b.h:12: ...". Empty when all is well.
using Violations = std::vector<std::string>;

/// Reads every telemime_module(...) below `root`/src/telemime. Rooms that depend on each other in a circle,
/// or on a module that does not exist, are violations.
Reach read_modules(const std::filesystem::path& root, Violations& violations);

/// Every #include "..." of every module: only of modules within reach, by the full path from src/.
Violations check_includes(const std::filesystem::path& root);

/// Every module of CMake has its row in the table of ARCHITECTURE.md.
Violations check_architecture_table(const std::filesystem::path& root);

/// Every source file: at most 400 lines, and an SPDX line at its top (after #! where there is one).
Violations check_sources(const std::filesystem::path& root);

/// No two headers of the modules define a type of one name in one namespace: a program that uses both would
/// be broken, and the linker is silent.
Violations check_names(const std::filesystem::path& root);

/// No text file says that something is still to be done or mended; such notes belong to an issue.
Violations check_no_leftovers(const std::filesystem::path& root);

}  // namespace telemime::layering
