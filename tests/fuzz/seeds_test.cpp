// SPDX-License-Identifier: Apache-2.0
// Every fuzz target reads its seeds. What a target takes for a fault ends the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

extern "C" {
int fuzz_calibration(const std::uint8_t* data, std::size_t size);
int fuzz_camera(const std::uint8_t* data, std::size_t size);
int fuzz_config(const std::uint8_t* data, std::size_t size);
int fuzz_network(const std::uint8_t* data, std::size_t size);
int fuzz_pose_jsonl(const std::uint8_t* data, std::size_t size);
int fuzz_sequence(const std::uint8_t* data, std::size_t size);
int fuzz_times(const std::uint8_t* data, std::size_t size);
int fuzz_truth(const std::uint8_t* data, std::size_t size);
}

namespace telemime {
namespace {

namespace fs = std::filesystem;

struct Target {
  const char* name;
  int (*read)(const std::uint8_t* data, std::size_t size);
};
constexpr Target kTargets[] = {{"calibration", fuzz_calibration},
                               {"camera", fuzz_camera},
                               {"config", fuzz_config},
                               {"network", fuzz_network},
                               {"pose_jsonl", fuzz_pose_jsonl},
                               {"sequence", fuzz_sequence},
                               {"times", fuzz_times},
                               {"truth", fuzz_truth}};

TEST(FuzzTargets, ReadTheirSeeds) {
  for (const Target& target : kTargets) {
    SCOPED_TRACE(target.name);
    int seeds = 0;
    for (const auto& seed :
         fs::directory_iterator(fs::path(TELEMIME_SOURCE_DIR) / "fuzz/corpus" / target.name)) {
      std::ifstream file(seed.path(), std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(file), {}};
      ASSERT_FALSE(bytes.empty()) << seed.path();
      // Whole, and as a file that a full disk cut off.
      for (const std::size_t size : {bytes.size(), bytes.size() / 2, std::size_t{0}}) {
        // A copy of its own, so that the address sanitizer sees who reads beyond its end.
        const auto cut = std::make_unique<std::uint8_t[]>(size);
        std::copy_n(bytes.begin(), size, cut.get());
        EXPECT_EQ(target.read(cut.get(), size), 0);
      }
      ++seeds;
    }
    EXPECT_GT(seeds, 0);
  }
}

// A new target is listed above.
TEST(FuzzTargets, AreAllListed) {
  std::size_t targets = 0;
  for (const auto& file : fs::directory_iterator(fs::path(TELEMIME_SOURCE_DIR) / "fuzz")) {
    targets += file.path().extension() == ".cpp" ? 1 : 0;
  }
  EXPECT_EQ(targets, std::size(kTargets));
}

}  // namespace
}  // namespace telemime
