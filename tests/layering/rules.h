// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace telemime::layering {

/// For each module the modules that it may include: itself, the DEPENDS of its CMakeLists.txt, theirs, and so
/// on.
using Reach = std::map<std::string, std::set<std::string>>;

/// One sentence for each violation: "src/telemime/a/b.h:12: ...".
using Violations = std::vector<std::string>;

/// Reads all telemime_module(...) calls of the project. Circular dependencies and dependencies on unknown
/// modules are violations.
Reach read_modules(const std::filesystem::path& root, Violations& violations);

/// Checks that each #include "..." of a module names a module within reach, by its full path.
Violations check_includes(const std::filesystem::path& root);

/// Checks that each module has a row in the table of ARCHITECTURE.md whose last column lists its DEPENDS.
Violations check_architecture_table(const std::filesystem::path& root);

/// Checks that each source file has at most 400 lines, and an SPDX line at its top (after #!, if any).
Violations check_sources(const std::filesystem::path& root);

/// Checks that no two headers define types of the same name in the same namespace: a program that uses both
/// would be broken without an error from the linker.
Violations check_names(const std::filesystem::path& root);

/// Checks that no CMake file asks for one exact version of a package: newer ones must do. The package files
/// of meshoptimizer and utf8cpp call every version incompatible with the others, so none may be named.
Violations check_versions(const std::filesystem::path& root);

/// Checks that no text file has notes about unfinished work; they belong in an issue.
Violations check_no_leftovers(const std::filesystem::path& root);

}  // namespace telemime::layering
