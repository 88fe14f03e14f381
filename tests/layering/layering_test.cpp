// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "rules.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::layering {
namespace {

namespace fs = std::filesystem;

const fs::path this_project = TELEMIME_SOURCE_DIR;

std::string as_text(const Violations& violations) {
  std::string text;
  for (const std::string& violation : violations) {
    text += "\n  " + violation;
  }
  return text;
}

TEST(ThisProject, ModulesIncludeOnlyWhatTheyList) {
  Violations violations;
  EXPECT_GE(read_modules(this_project, violations).size(), 10U);
  EXPECT_EQ(as_text(check_includes(this_project)), "");
}

TEST(ThisProject, ArchitectureTableListsTheModules) {
  EXPECT_EQ(as_text(check_architecture_table(this_project)), "");
}

TEST(ThisProject, SourcesAreShortAndLicensed) {
  EXPECT_EQ(as_text(check_sources(this_project)), "");
}

TEST(ThisProject, TypeNamesAreUnique) {
  EXPECT_EQ(as_text(check_names(this_project)), "");
}

TEST(ThisProject, HasNoLeftovers) {
  EXPECT_EQ(as_text(check_no_leftovers(this_project)), "");
}

TEST(ThisProject, NeedsNoExactVersion) {
  EXPECT_EQ(as_text(check_versions(this_project)), "");
}

/// Runs scripts/deps.sh where dpkg-query is the lines `query` and apt-get the lines `get`.
struct DepsRun {
  DepsRun(const std::string& query, const std::string& get) {
    program("dpkg-query", query);
    program("sudo", "exec \"$@\"\n");
    program("apt-get", get);
    const std::string command = "PATH='" + bin.string() + "':\"$PATH\" APT_LOG='" + (bin / "log").string() +
                                "' '" + (this_project / "scripts/deps.sh").string() + "' build > '" +
                                (bin / "out").string() + "' 2>&1";
    status = std::system(command.c_str());
  }
  void program(const std::string& name, const std::string& lines) const {
    std::ofstream(bin / name) << "#!/bin/sh\n" << lines;
    fs::permissions(bin / name, fs::perms::owner_all);
  }
  std::string text(const std::string& name) const {
    std::ifstream file(bin / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  ScratchFolder scratch;
  fs::path bin = scratch.path();
  int status = -1;
};

// As on a system that has other versions than those that are tested with.
TEST(ThisProject, InstallsTheVersionsThatAreOffered) {
  const DepsRun run("exit 1\n",
                    "case \"$*\" in *=*) exit 100;; install*) echo \"$*\" > \"$APT_LOG\";; esac\n");
  EXPECT_EQ(run.status, 0);
  const std::string taken = run.text("log");
  for (const char* const package : {"libeigen3-dev", "libopencv-core-dev", "libmeshoptimizer-dev"}) {
    EXPECT_NE(taken.find(package), std::string::npos) << taken;
  }
}

TEST(ThisProject, KeepsOtherVersionsThatAreThere) {
  const DepsRun run("echo 'ii 99:1'\n", "exit 100\n");
  EXPECT_EQ(run.status, 0) << "apt-get was called: " << run.text("out");
  EXPECT_NE(run.text("out").find("libeigen3-dev 99:1"), std::string::npos) << run.text("out");
}

/// A correct project of three modules. Each test breaks one rule and expects its violation.
class SmallProject : public ::testing::Test {
 protected:
  SmallProject() { write_all(); }

  void write_all() const {
    write("ARCHITECTURE.md", "| `low` | one | - |\n| `high` | two | low |\n| `attic` | three | high |\n");
    write("src/telemime/low/CMakeLists.txt", licence("#") + "telemime_module(low LIBRARIES high)\n");
    write("src/telemime/low/low.h", licence("//") + "#include <vector>\n");
    write("src/telemime/high/CMakeLists.txt",
          licence("#") + "telemime_module(high\n  DEPENDS low LIBRARIES z)\n");
    write("src/telemime/high/high.cpp", licence("//") + "#include \"telemime/low/low.h\"\n");
    write("src/telemime/attic/CMakeLists.txt", licence("#") + "telemime_module(attic DEPENDS high)\n");
    write("src/telemime/attic/attic.cpp", licence("//") + "#include \"telemime/low/low.h\"\n");
    write("scripts/run.sh", "#!/bin/sh\n" + licence("#"));
  }

  static std::string licence(const std::string& comment) {
    return comment + " SPDX-License-Identifier: Apache-2.0\n";
  }
  void write(const std::string& name, const std::string& content) const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << content;
  }
  /// All violations as one text.
  std::string violations() const {
    return as_text(check_includes(root_)) + as_text(check_architecture_table(root_)) +
           as_text(check_sources(root_)) + as_text(check_names(root_)) + as_text(check_no_leftovers(root_)) +
           as_text(check_versions(root_));
  }
  void expect_violation(const std::string& text) const {
    EXPECT_NE(violations().find(text), std::string::npos) << violations();
  }

  ScratchFolder folder_;
  fs::path root_ = folder_.path();
};

TEST_F(SmallProject, HasNoViolations) {
  Violations none;
  EXPECT_EQ(read_modules(root_, none).at("attic"), (std::set<std::string>{"attic", "high", "low"}));
  EXPECT_EQ(violations(), "");
}

TEST_F(SmallProject, FindsEachViolation) {
  struct Case {
    std::string file;
    std::string content;
    std::string violation;
  };
  const std::string rows = "| `high` | two | low |\n| `attic` | three | high |\n";
  for (const Case& wrong : std::vector<Case>{
           {"src/telemime/low/deep/wrong.h", licence("//") + "\n  #  include <telemime/high/high.h>\n",
            "src/telemime/low/deep/wrong.h:3: module low includes module high"},
           {"src/telemime/low/low_test.cpp", licence("//") + "#include \"telemime/high/high.h\"\n",
            "low_test.cpp:2: module low includes module high"},
           {"src/telemime/low/wrong.h", licence("//") + "#include \"../high/high.h\"\n",
            "wrong.h:2: write \"telemime/<module>/"},
           {"src/telemime/low/CMakeLists.txt", licence("#") + "telemime_module(low DEPENDS attic)\n",
            "depends on itself"},
           {"src/telemime/low/CMakeLists.txt", licence("#") + "telemime_module(low DEPENDS cellar)\n",
            "'cellar', which is not a module"},
           {"ARCHITECTURE.md", "| `low` | one | high |\n" + rows,
            "the row of module low does not list its DEPENDS"},
           {"ARCHITECTURE.md", rows, "module low has no row"},
           {"scripts/bare.sh", "#!/bin/sh\necho\n", "scripts/bare.sh:2: the line SPDX"},
           {"scripts/bare.sh", "", "scripts/bare.sh:1: the line SPDX"},
       }) {
    write(wrong.file, wrong.content);
    expect_violation(wrong.violation);
    fs::remove_all(root_ / "src");
    fs::remove_all(root_ / "scripts");
    write_all();
  }
  EXPECT_EQ(violations(), "");
}

TEST_F(SmallProject, FindsALongFile) {
  std::string lines = licence("//");
  for (int i = 1; i < 400; ++i) {
    lines += "\n";
  }
  write("apps/long.cpp", lines);
  EXPECT_EQ(violations(), "");
  write("apps/long.cpp", lines + "\n");
  expect_violation("apps/long.cpp:401: ");
}

TEST_F(SmallProject, FindsTwoTypesOfTheSameName) {
  const std::string type = licence("//") + "namespace telemime {\nstruct Options {\n};\n}\n";
  write("src/telemime/low/options.h", type);
  EXPECT_EQ(violations(), "");
  write("src/telemime/high/options.h", type);
  expect_violation("src/telemime/low/options.h:3: telemime::Options is also the name of another type");
  write("src/telemime/high/options.h",
        licence("//") + "namespace telemime::high {\nclass Options final : public Base {\n};\n}\n");
  EXPECT_EQ(violations(), "") << "another namespace is another name";
}

TEST_F(SmallProject, FindsALeftoverInAnyTextFile) {
  write("docs/plan.md", std::string("one\nlater: TO") + "DO\n");
  write(".ci/run", std::string("# FIX") + "ME(all) now\n");
  expect_violation("docs/plan.md:2: ");
  expect_violation(".ci/run:1: ");
}

TEST_F(SmallProject, FindsAnExactVersion) {
  for (const char* const line :
       {"find_package(Eigen3 3.4 EXACT)", "find_package(meshoptimizer 0.18 REQUIRED)",
        "find_dependency(meshoptimizer 0.18)", "if(OpenCV_VERSION VERSION_EQUAL 4.6)"}) {
    write("cmake/Extra.cmake", licence("#") + "find_package(hwy 1.0 REQUIRED)\n" + line + "\n");
    expect_violation("cmake/Extra.cmake:3: newer versions must do");
  }
}

TEST_F(SmallProject, IgnoresForeignFiles) {
  const std::string leftover = std::string("TO") + "DO\n";
  write("build/release/generated.cpp", leftover);
  write("web/node_modules/x/index.js", leftover);
  write("data/clip.bin", std::string(3, '\0') + leftover);
  EXPECT_EQ(violations(), "");
}

}  // namespace
}  // namespace telemime::layering
