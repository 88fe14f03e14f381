// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "telemime/nets/models/table.h"

/// What tests need that a build may lack: the networks, and clips that are not in the repository. Tests that
/// lack something are skipped, with the reason.
namespace telemime::support {

/// The folder of the clips: the environment variable TELEMIME_DATA, otherwise shared/data beside the project.
inline std::filesystem::path test_data() {
  const char* const variable = std::getenv("TELEMIME_DATA");
  return variable != nullptr ? variable : TELEMIME_SOURCE_DIR "/../shared/data";
}

inline constexpr const char* kNoClips = "no test data: set TELEMIME_DATA";

/// Tests that need the networks of this build.
class WithNetworks : public ::testing::Test {
 protected:
  void SetUp() override {
    std::vector<std::string> names;
    for (const ModelFile& model : model_table()) {
      names.emplace_back(model.name);
    }
    if (const std::string missing = missing_models(TELEMIME_BUILD_MODELS, names); !missing.empty()) {
      GTEST_SKIP() << missing;
    }
  }
};

/// Tests that need the networks and the clips.
class WithClips : public WithNetworks {
 protected:
  void SetUp() override {
    WithNetworks::SetUp();
    for (const char* const folder : {"real", "dev", "dev_practical"}) {
      if (!IsSkipped() && !std::filesystem::exists(test_data() / folder)) {
        GTEST_SKIP() << kNoClips;
      }
    }
  }
};

}  // namespace telemime::support
