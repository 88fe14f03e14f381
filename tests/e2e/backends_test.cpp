// SPDX-License-Identifier: Apache-2.0
// Back ends as a user chooses and measures them.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "exit_codes.h"
#include "run_program.h"
#include "telemime/likelihood/all.h"

namespace telemime::e2e {
namespace {

TEST(Bench, MeasuresTheBackEndsThatWereAskedFor) {
  const ScratchFolder folder;
  const std::string file = (folder.path() / "bench.json").string();
  const Ended ended = run({"bench", "--engine-only", "--quick", "--backend", "simd", "--json", file});
  ASSERT_EQ(ended.code, 0) << ended.words;
  EXPECT_NE(ended.output.find("Thousand evaluations"), std::string::npos);
  EXPECT_EQ(ended.output.find("scalar  "), std::string::npos) << "only simd was asked for";
  std::ifstream in(file);
  const nlohmann::json tables = nlohmann::json::parse(in);
  ASSERT_TRUE(tables.is_array());
  EXPECT_GE(tables.size(), 5U);
}

TEST(Bench, WatchesTheMemory) {
  const Ended ended = run({"bench", "--soak", "0.01"});
  EXPECT_EQ(ended.code, 0) << ended.words;
  EXPECT_NE(ended.output.find("10/10"), std::string::npos);
}

TEST(Backends, ThatCannotRunOrDoNotExistAreRefusedInWords) {
  const Ended unknown = run({"bench", "--engine-only", "--backend", "abacus"});
  EXPECT_EQ(unknown.code, kExitUsage);
  EXPECT_NE(unknown.words.find("simd"), std::string::npos) << "the choices are named: " << unknown.words;
  for (const BackendKind& kind : kBackends) {
    if (!kind.missing().empty()) {
      const Ended ended = run({"bench", "--engine-only", "--backend", std::string(kind.name)});
      EXPECT_EQ(ended.code, kExitUsage);
      EXPECT_NE(ended.words.find(kind.missing()), std::string::npos) << ended.words;
    }
  }
}

}  // namespace
}  // namespace telemime::e2e
