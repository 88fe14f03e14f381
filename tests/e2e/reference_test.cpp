// SPDX-License-Identifier: Apache-2.0
// What the program writes about its own options - manual pages, completion - and docs/cli.md beside it.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "run_program.h"

namespace telemime::e2e {
namespace {

namespace fs = std::filesystem;
using Words = std::set<std::string>;

const Folder& reference() {
  static const Folder folder;
  static const Ended ended = run({"--write-reference", folder / ""});
  EXPECT_EQ(ended.code, 0) << ended.words;
  return folder;
}

Words matches(const std::string& text, const std::regex& pattern) {
  Words found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) {
    found.insert((*at)[1]);
  }
  return found;
}

// The long options of each command, "telemime live", as its help text lists them.
std::map<std::string, Words> options() {
  std::map<std::string, Words> all;
  const std::string completion = bytes_of(reference() / "completions/telemime");
  for (const std::string& command : matches(completion, std::regex("\"(telemime[a-z ]*)\"\\) words="))) {
    std::vector<std::string> arguments = {"--help"};
    std::istringstream words(command.substr(8));
    for (std::string word; words >> word;) {
      arguments.insert(arguments.end() - 1, word);
    }
    all[command] = matches(run(arguments).output, std::regex("[ ,](--[a-z][a-z-]*)(?=[ ,{=\\n])"));
  }
  return all;
}

// What bash offers for the last of these words.
std::string completed(const std::string& words, int last) {
  const std::string script = "source '" + (reference() / "completions/telemime") + "'; COMP_WORDS=(" + words +
                             "); COMP_CWORD=" + std::to_string(last) +
                             "; _telemime; echo -n \"${COMPREPLY[*]}\"";
  const auto quoted = "bash -c '" + std::regex_replace(script, std::regex("'"), "'\\''") + "'";
  FILE* const bash = ::popen(quoted.c_str(), "r");
  std::array<char, 4096> line{};
  const std::size_t count = std::fread(line.data(), 1, line.size(), bash);
  EXPECT_EQ(::pclose(bash), 0);
  return {line.data(), count};
}

// The option, or the one that switches off what it switches on or the other way round.
bool has(const Words& words, const std::string& option) {
  return words.contains(option) || words.contains("--no-" + option.substr(2)) ||
         (option.starts_with("--no-") && words.contains("--" + option.substr(5)));
}

TEST(Reference, PageOfEachCommandHasItsOptions) {
  for (const auto& [command, names] : options()) {
    const std::string file = std::regex_replace(command, std::regex(" "), "-") + ".1";
    const std::string page =
        std::regex_replace(bytes_of(reference() / ("man1/" + file)), std::regex("\\\\-"), "-");
    EXPECT_TRUE(page.find("\n.SH NAME\n") != std::string::npos) << file;
    EXPECT_FALSE(names.empty()) << command;
    for (const std::string& name : names) {
      EXPECT_TRUE(page.find("\\fB" + name + "\\fR") != std::string::npos)
          << file << " does not have " << name;
    }
  }
}

TEST(Reference, BashCompletesCommandsOptionsValues) {
  EXPECT_EQ(completed("telemime e", 1), "evaluate");
  EXPECT_EQ(completed("telemime meeting re", 2), "record replay");
  EXPECT_EQ(completed("telemime track clip.mp4 --form", 3), "--formats");
  EXPECT_EQ(completed("telemime track --backend s", 3), "simd scalar");
  EXPECT_EQ(completed("telemime track cl", 2), "") << "files are left to bash";
}

TEST(Reference, DocumentsHaveTheOptionsOfTheProgram) {
  const std::string document = bytes_of(fs::path(TELEMIME_SOURCE_DIR) / "docs/cli.md");
  std::map<std::string, Words> documented;
  std::string command;
  std::istringstream lines(document);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## ")) {
      command = "telemime " + line.substr(3);
    } else if (line.starts_with("| `--")) {
      documented[command].merge(matches(line.substr(0, line.find(" | ", 2)), std::regex("(--[a-z][a-z-]*)")));
    }
  }
  const auto all = options();
  for (const auto& [name, given] : documented) {
    ASSERT_TRUE(all.contains(name)) << name;
    for (const std::string& option : given) {
      EXPECT_TRUE(all.at(name).contains(option)) << "there is no " << name << " " << option;
    }
  }
  for (const std::string name :
       {"telemime live", "telemime meeting", "telemime track", "telemime evaluate"}) {
    Words given = documented[name];
    if (name == "telemime live") {
      given.insert(documented["telemime track"].begin(), documented["telemime track"].end());
    }
    for (const std::string& option : all.at(name)) {
      EXPECT_TRUE(option == "--help" || has(given, option))
          << "docs/cli.md does not have " << name << " " << option;
    }
  }
}

}  // namespace
}  // namespace telemime::e2e
