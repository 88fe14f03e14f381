// SPDX-License-Identifier: Apache-2.0
#include "rules.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <string_view>

namespace telemime::layering {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_lines = 400;
// Blender installs an add-on that is one file.
constexpr std::string_view add_on = "integrations/blender/telemime.py";
constexpr std::size_t most_lines_of_add_on = 490;
// Folders without sources of this project.
constexpr std::array<std::string_view, 6> foreign = {".git",         "build", "out",
                                                     "node_modules", "dist",  ".cache"};
constexpr std::array<std::string_view, 15> source_endings = {".h",  ".cpp", ".cc", ".hpp", ".cmake",
                                                             ".sh", ".py",  ".ts", ".js",  ".mjs",
                                                             ".cl", ".inc", ".cu", ".css", ".html"};

template <typename List>
bool contains(const List& list, std::string_view item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// All regular files of the project below `folder`, sorted.
std::vector<fs::path> project_files(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) {
    return files;
  }
  fs::recursive_directory_iterator entry(folder);
  for (; entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry->is_directory() && contains(foreign, entry->path().filename().string())) {
      entry.disable_recursion_pending();
    } else if (entry->is_regular_file() && !entry->is_symlink()) {
      files.push_back(entry->path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool is_source(const fs::path& file) {
  const std::string name = file.filename().string();
  return contains(source_endings, file.extension().string()) || name == "CMakeLists.txt" ||
         name == "Makefile";
}

bool is_text(const std::string& content) {
  return content.find('\0') == std::string::npos;
}

std::string place(const fs::path& root, const fs::path& file, std::size_t line) {
  return fs::relative(file, root).string() + ":" + std::to_string(line) + ": ";
}

/// The words after DEPENDS up to the next keyword.
std::set<std::string> depends_of(const std::string& arguments) {
  std::set<std::string> modules;
  bool listed = false;
  std::istringstream words(arguments);
  for (std::string word; words >> word;) {
    if (word == "DEPENDS" || word == "LIBRARIES" || word == "INCLUDE") {
      listed = word == "DEPENDS";
    } else if (listed) {
      modules.insert(word);
    }
  }
  return modules;
}

std::string unknown_module(const std::string& module, const std::string& next) {
  return "module " + module + " depends on '" + next + "', which is not a module";
}

std::string out_of_reach(const std::string& module, const std::string& included) {
  return "module " + module + " includes module " + included +
         ", which is not in the DEPENDS of its CMakeLists.txt";
}

Reach close_over(const Reach& direct, Violations& violations) {
  Reach reach;
  std::set<std::string> open;
  const std::function<std::set<std::string>(const std::string&)> visit = [&](const std::string& module) {
    if (const auto known = reach.find(module); known != reach.end()) {
      return known->second;
    }
    std::set<std::string> all{module};
    if (!open.insert(module).second) {
      violations.push_back("module " + module + " depends on itself, through others");
      return all;
    }
    for (const std::string& next : direct.at(module)) {
      if (direct.contains(next)) {
        all.merge(visit(next));
      } else {
        violations.push_back(unknown_module(module, next));
      }
    }
    open.erase(module);
    reach[module] = all;
    return all;
  };
  for (const auto& [module, ignored] : direct) {
    visit(module);
  }
  return reach;
}

/// Where modules lie, and the first word of the #include lines that reach them. In the names of targets the
/// word stands before the folder's name, but for the library's own.
struct ModuleHome {
  std::string_view folder;
  std::string_view include;
  std::string_view prefix;
};
constexpr std::array<ModuleHome, 4> homes = {{{"src/telemime", "telemime", ""},
                                              {"apps/lab", "lab", "lab_"},
                                              {"apps/avatars", "avatars", ""},
                                              {"meeting/src/meeting", "meeting", "meeting_"}}};

/// The module that an #include line names; empty for a file of others.
std::string included_module(const fs::path& target) {
  for (const ModuleHome& home : homes) {
    if (*target.begin() == home.include) {
      return home.include == "avatars" ? "avatars"
                                       : std::string(home.prefix) + std::next(target.begin())->string();
    }
  }
  return {};
}

/// Each module's folder.
std::map<std::string, fs::path> module_folders(const fs::path& root, Reach& direct) {
  static const std::regex call(R"(telemime_module\(\s*(\w+)([^)]*)\))");
  std::map<std::string, fs::path> folders;
  for (const ModuleHome& home : homes) {
    for (const fs::path& file : project_files(root / home.folder)) {
      if (file.filename() != "CMakeLists.txt") {
        continue;
      }
      const std::string text = std::regex_replace(content_of(file), std::regex("#[^\n]*"), "");
      std::smatch found;
      if (std::regex_search(text, found, call)) {
        direct[found.str(1)] = depends_of(found.str(2));
        folders[found.str(1)] = file.parent_path();
      }
    }
  }
  return folders;
}

}  // namespace

Reach read_modules(const fs::path& root, Violations& violations) {
  Reach direct;
  module_folders(root, direct);
  return close_over(direct, violations);
}

Violations check_includes(const fs::path& root) {
  static const std::regex include(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  Violations violations;
  const Reach reach = read_modules(root, violations);
  Reach direct;
  for (const auto& [module, folder] : module_folders(root, direct)) {
    const std::set<std::string>& may_include = reach.at(module);
    for (const fs::path& file : project_files(folder)) {
      const std::vector<std::string> lines = lines_of(is_source(file) ? content_of(file) : std::string());
      for (std::size_t i = 0; i < lines.size(); ++i) {
        std::smatch found;
        if (!std::regex_search(lines[i], found, include)) {
          continue;
        }
        const fs::path target = found.str(2);
        const std::string included = included_module(target);
        if (!included.empty() && !may_include.contains(included)) {
          violations.push_back(place(root, file, i + 1) + out_of_reach(module, included));
        } else if (included.empty() && found.str(1) == "\"" && *target.begin() != "cli" &&
                   target.extension() != ".inc") {  // .inc: a generated table; cli: what programs share
          violations.push_back(place(root, file, i + 1) +
                               "write \"telemime/<module>/...\" for files of this project " +
                               "and <...> for those of others");
        }
      }
    }
  }
  return violations;
}

Violations check_architecture_table(const fs::path& root) {
  static const std::regex row(R"(\| `(\w+)` \|.*\| ([\w, -]+) \|)");
  Reach rows;
  for (const std::string& line : lines_of(content_of(root / "ARCHITECTURE.md"))) {
    if (std::smatch found; std::regex_match(line, found, row)) {
      const std::string names = std::regex_replace(found.str(2), std::regex("[,-]"), "");
      rows[found.str(1)] = depends_of("DEPENDS " + names);
    }
  }
  Violations violations;
  Reach direct;
  module_folders(root, direct);
  for (const auto& [module, depends] : direct) {
    if (!rows.contains(module)) {
      violations.push_back("ARCHITECTURE.md: module " + module + " has no row in the table of modules");
    } else if (rows.at(module) != depends) {
      violations.push_back("ARCHITECTURE.md: the row of module " + module + " does not list its DEPENDS");
    }
  }
  return violations;
}

Violations check_sources(const fs::path& root) {
  Violations violations;
  for (const fs::path& file : project_files(root)) {
    if (!is_source(file)) {
      continue;
    }
    const std::vector<std::string> lines = lines_of(content_of(file));
    const std::size_t most = fs::relative(file, root) == add_on ? most_lines_of_add_on : most_lines;
    if (lines.size() > most) {
      violations.push_back(place(root, file, lines.size()) + "the file has more than " +
                           std::to_string(most) + " lines; split it");
    }
    const std::size_t top = !lines.empty() && lines[0].starts_with("#!") ? 1 : 0;
    if (lines.size() <= top || lines[top].find("SPDX-License-Identifier: Apache-2.0") == std::string::npos) {
      violations.push_back(place(root, file, top + 1) +
                           "the line SPDX-License-Identifier: Apache-2.0 is missing");
    }
  }
  return violations;
}

Violations check_names(const fs::path& root) {
  static const std::regex space("^namespace ([\\w:]+) \\{");
  static const std::regex type("^(?:struct|class|enum class) (\\w+)(?: final)?(?: :[^;]*)? \\{");
  std::map<std::string, std::string> first;
  Violations violations;
  for (const fs::path& file : project_files(root / "src" / "telemime")) {
    if (file.extension() != ".h") {
      continue;
    }
    std::string where;
    std::smatch found;
    const std::vector<std::string> lines = lines_of(content_of(file));
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (std::regex_search(lines[i], found, space)) {
        where = found[1];
      } else if (std::regex_search(lines[i], found, type)) {
        const auto [other, first_time] =
            first.emplace(where + "::" + found[1].str(), place(root, file, i + 1));
        if (!first_time) {
          violations.push_back(place(root, file, i + 1) + other->first +
                               " is also the name of another type: " + other->second);
        }
      }
    }
  }
  return violations;
}

Violations check_versions(const fs::path& root) {
  static const std::regex exact(
      "find_package *\\(.*\\bEXACT\\b|\\bVERSION_EQUAL\\b|find_(package|dependency) "
      "*\\((meshoptimizer|utf8cpp) +[0-9]");
  Violations violations;
  for (const fs::path& file : project_files(root)) {
    if (file.filename() != "CMakeLists.txt" && file.extension() != ".cmake" && file.extension() != ".in") {
      continue;
    }
    const std::vector<std::string> lines = lines_of(content_of(file));
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (std::regex_search(lines[i], exact)) {
        violations.push_back(place(root, file, i + 1) + "newer versions must do: " + lines[i]);
      }
    }
  }
  return violations;
}

Violations check_no_leftovers(const fs::path& root) {
  // Concatenated, so that this file does not contain them.
  static const std::regex leftover(std::string("\\b(TO") + "DO|FIX" + "ME)\\b");
  Violations violations;
  for (const fs::path& file : project_files(root)) {
    const std::string content = content_of(file);
    if (!is_text(content)) {
      continue;
    }
    const std::vector<std::string> lines = lines_of(content);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      constexpr std::size_t longest_line = 2000;  // longer ones are data
      if (lines[i].size() < longest_line && std::regex_search(lines[i], leftover)) {
        violations.push_back(place(root, file, i + 1) + "do it, or open an issue: " + lines[i]);
      }
    }
  }
  return violations;
}

}  // namespace telemime::layering
