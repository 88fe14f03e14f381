// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/installed.h"

#include <gtest/gtest.h>

#include <fstream>

#include "telemime/core/scratch_folder.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

TEST(Installed, CodeOfAProgramIsInItsFolder) {
  EXPECT_EQ(code_folder(), fs::read_symlink("/proc/self/exe").parent_path());
}

TEST(Installed, DataLiesBelowTheNearestParent) {
  const ScratchFolder scratch;
  const fs::path usr = scratch.path() / "usr";
  for (const char* const folder : {"bin", "share/telemime/models", "local/bin", "local/share/telemime"}) {
    fs::create_directories(usr / folder);
  }
  std::ofstream(usr / "local/share/telemime/filter.json") << "{}";
  EXPECT_EQ(installed_folder(usr / "bin", "models"), usr / "share/telemime");
  EXPECT_EQ(installed_folder(usr / "lib/python3/dist-packages/telemime", "models"), usr / "share/telemime");
  EXPECT_EQ(installed_folder(usr / "local/bin", "filter.json"), usr / "local/share/telemime");
  EXPECT_EQ(installed_folder(usr / "local/bin", "models"), usr / "share/telemime");
  EXPECT_EQ(installed_folder(usr / "bin", "no such data"), fs::path());
}

}  // namespace
}  // namespace telemime
