// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/secrets.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "meeting/protocol/testing.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::meeting {
namespace {

namespace fs = std::filesystem;

mode_t mode_of(const fs::path& file) {
  struct stat about {};
  EXPECT_EQ(::stat(file.c_str(), &about), 0) << file;
  return about.st_mode & 07777;
}

std::string refusal(const fs::path& file) {
  return error_of([&] { SecretsFile(file).load(); });
}

class Secrets : public ::testing::Test {
 protected:
  ScratchFolder folder_;
  fs::path file_ = folder_.path() / "state" / "telemime" / "blue.json";
};

TEST_F(Secrets, AreTheSameTheNextTime) {
  const MeetingSecrets first = SecretsFile(file_).load();
  const MeetingSecrets second = SecretsFile(file_).load();
  EXPECT_EQ(first.speak, second.speak);
  EXPECT_EQ(first.watch, second.watch);
  EXPECT_EQ(first.chair, second.chair);
  EXPECT_EQ(first.key, second.key);
  EXPECT_EQ(first.next, 1U);
  MeetingSecrets later = first;
  later.next = 7;
  SecretsFile(file_).save(later);
  EXPECT_EQ(SecretsFile(file_).load().next, 7U);
}

TEST_F(Secrets, AreForTheirOwnerOnly) {
  const mode_t before = ::umask(0);
  SecretsFile(file_).load();
  ::umask(before);
  EXPECT_EQ(mode_of(file_), 0600U);
  EXPECT_EQ(mode_of(file_.parent_path()), 0700U);
  EXPECT_EQ(mode_of(file_.parent_path().parent_path()), 0700U);
  const auto entries = fs::directory_iterator(file_.parent_path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 2)
      << "it and its lock: nothing is left of the writing";
}

TEST_F(Secrets, FileThatOthersCanReadIsRejected) {
  const MeetingSecrets secrets = SecretsFile(file_).load();
  for (const mode_t mode : {0640U, 0604U, 0644U, 0620U, 0610U}) {
    ASSERT_EQ(::chmod(file_.c_str(), mode), 0);
    const std::string text = refusal(file_);
    EXPECT_NE(text.find("other users of this computer can read it"), std::string::npos) << text;
    EXPECT_NE(text.find("chmod 600"), std::string::npos) << text;
    EXPECT_EQ(text.find(secrets.speak), std::string::npos);
  }
  ASSERT_EQ(::chmod(file_.c_str(), 0600), 0);
  EXPECT_EQ(refusal(file_), "");
}

TEST_F(Secrets, OtherFilesAreRejected) {
  SecretsFile(file_).load();
  const std::string good = content_of(file_);
  for (const std::string& bad : {std::string(), std::string("{}"), std::string("[1]"),
                                 good.substr(0, good.size() / 2), good + good, std::string(5000, ' ')}) {
    std::ofstream(file_) << bad;
    EXPECT_NE(refusal(file_).find("cannot be read from"), std::string::npos) << bad;
  }
  const fs::path link = folder_.path() / "link.json";
  fs::create_symlink(file_, link);
  EXPECT_NE(refusal(link).find("link"), std::string::npos) << refusal(link);
  const fs::path directory = folder_.path() / "folder.json";
  fs::create_directory(directory);
  EXPECT_NE(refusal(directory).find("not a regular file"), std::string::npos) << refusal(directory);
  std::ofstream(folder_.path() / "file") << "x";
  EXPECT_NE(refusal(folder_.path() / "file" / "blue.json"), "");
}

TEST_F(Secrets, MeetingIsOpenedOnce) {
  const SecretsFile open(file_);
  EXPECT_NE(refusal(file_).find("already open"), std::string::npos);
}

TEST_F(Secrets, NewOnesDiffer) {
  const MeetingSecrets one = new_secrets();
  const MeetingSecrets two = new_secrets();
  EXPECT_NE(one.speak, two.speak);
  EXPECT_NE(one.key, two.key);
  EXPECT_NE(one.speak, one.chair);
}

TEST(SecretsPath, FollowsTheXdgSpecification) {
  EXPECT_EQ(default_secrets_file("blue", "/state", "/home/ana"), "/state/telemime/rooms/blue.json");
  EXPECT_EQ(default_secrets_file("blue", nullptr, "/home/ana"),
            "/home/ana/.local/state/telemime/rooms/blue.json");
  EXPECT_EQ(default_secrets_file("blue", "relative", "/home/ana"),
            "/home/ana/.local/state/telemime/rooms/blue.json");
  EXPECT_THROW(default_secrets_file("blue", nullptr, nullptr), Error);
}

}  // namespace
}  // namespace telemime::meeting
