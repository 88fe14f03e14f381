// SPDX-License-Identifier: Apache-2.0
// With scripts that end and hang as Mosquitto may.
#include "meeting/hosting/broker_process.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <memory>
#include <vector>

#include "meeting/protocol/testing.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/streaming/testing_web.h"

namespace telemime::meeting {
namespace {

class BrokerProcesses : public ::testing::Test {
 protected:
  /// Starts a shell script; "$2" is the path of its configuration.
  void start(const std::string& script) {
    const std::filesystem::path program = folder_.path() / "program";
    std::ofstream(program) << script;
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    process_ = std::make_unique<BrokerProcess>(program, notes_, [this](const std::string& text) {
      const std::lock_guard lock(mutex_);
      reports_.push_back(text);
    });
  }
  std::vector<std::string> reports() const {
    const std::lock_guard lock(mutex_);
    return reports_;
  }
  std::string notes() const { return content_of(notes_); }
  /// A program's runs, which write a line each.
  std::ptrdiff_t runs() const {
    const std::string text = notes();
    return std::count(text.begin(), text.end(), '\n');
  }

  ScratchFolder folder_;
  std::filesystem::path notes_ = folder_.path() / "notes";
  mutable std::mutex mutex_;
  std::vector<std::string> reports_;
  std::unique_ptr<BrokerProcess> process_;
};

TEST_F(BrokerProcesses, FailedStartIsReportedOnce) {
  std::ofstream(folder_.file("notes.why")) << "Error: Address already in use";
  start(
      "#!/bin/sh\necho run >> \"$2\"\necho first\n"
      "echo \"$(date +%s%N): $(cat \"$2.why\")\"\necho '17: Warning: x'\nexit 1\n");
  process_->keep_running();
  ASSERT_TRUE(comes_true([&] { return runs() >= 4; }));
  const std::string first = "the broker ended (code 1: Error: Address already in use); restarting it";
  EXPECT_EQ(reports(), std::vector<std::string>{first});
  std::ofstream(folder_.file("notes.why")) << "Error: Out of memory";
  ASSERT_TRUE(comes_true([&] { return reports().size() > 1; }));
  EXPECT_EQ(reports()[1], "the broker ended (code 1: Error: Out of memory); restarting it");
}

TEST_F(BrokerProcesses, ProgramThatCannotBeExecutedSaysWhy) {
  start("#!/nothing/here\n");
  ASSERT_TRUE(comes_true([&] { return process_->has_ended(); }));
  EXPECT_EQ(process_->ending(),
            "code 127: " + folder_.file("program") + " cannot be started: No such file or directory");
}

TEST_F(BrokerProcesses, SilentProgramHasItsExitCode) {
  start("#!/bin/sh\nexit 3\n");
  ASSERT_TRUE(comes_true([&] { return process_->has_ended(); }));
  EXPECT_EQ(process_->ending(), "code 3");
}

TEST_F(BrokerProcesses, ProgramThatClosesItsOutputIsEnded) {
  start("#!/bin/sh\nexec >&- 2>&-\necho closed > \"$2\"\nexec sleep 30\n");
  ASSERT_TRUE(comes_true([&] { return notes() == "closed\n"; }));
  EXPECT_FALSE(process_->has_ended());
  const auto begun = std::chrono::steady_clock::now();
  process_.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(15));
}

}  // namespace
}  // namespace telemime::meeting
