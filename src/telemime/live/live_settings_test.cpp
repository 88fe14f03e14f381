// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_settings.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <thread>

#include "telemime/core/files.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/core/testing_errors.h"
#include "telemime/live/testing_settings.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

class Settings : public ::testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(file_, std::ios::binary) << text; }
  std::string refusal() const {
    return error_of(ErrorKind::config, [&] { load_settings(file_); });
  }

  ScratchFolder folder_;
  fs::path file_ = folder_.path() / "a" / "b" / "live.json";
};

TEST_F(Settings, ComeBackAsTheyWere) {
  EXPECT_TRUE(load_settings(file_).empty()) << "there is no file at first";
  const std::vector<std::string> urls = {"vmc://localhost", "ws://h:1/\"\\x?\xFF"};
  save_settings(file_, urls);
  const std::vector<std::string> back = load_settings(file_);
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[0], urls[0]);
  EXPECT_EQ(back[1], "ws://h:1/\"\\x?\xEF\xBF\xBD") << "what is not UTF-8 becomes a mark";
  save_settings(file_, {});
  EXPECT_TRUE(load_settings(file_).empty());
  EXPECT_EQ(std::distance(fs::directory_iterator(file_.parent_path()), fs::directory_iterator()), 1)
      << "nothing is left beside it";
  struct stat facts {};
  ASSERT_EQ(::stat(file_.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777, 0600) << "an address may hold a key";
}

TEST_F(Settings, AFileThatIsDamagedIsRefusedInWordsAndStays) {
  save_settings(file_, {});
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("[]"), std::string("{\"version\":1}"),
        std::string(R"({"version":1,"outputs":"vmc://localhost"})"),
        std::string(R"({"version":1,"outputs":[7]})"), std::string(R"({"version":2,"outputs":[]})"),
        std::string(R"({"outputs":[]})"), std::string("\0\xFF", 2), std::string(200000, ' '),
        std::string(90000, '[')}) {
    write(text);
    const std::string words = refusal();
    EXPECT_NE(words.find(file_.string()), std::string::npos) << text.substr(0, 50);
    EXPECT_EQ(fs::file_size(file_), text.size());
  }
  write(R"({"version":1,"outputs":["vmc://a"],"more":{"of":"a later version"}})");
  EXPECT_EQ(load_settings(file_).size(), 1U);
  fs::remove(file_);
  fs::create_directory(file_);
  EXPECT_NE(refusal(), "") << "a folder of that name";
}

TEST_F(Settings, AFileThatCannotBeUsedIsKeptBesideTheNewOne) {
  save_settings(file_, {});
  const std::string theirs = R"({"version":2,"outputs":["vmc://a"]})";
  write(theirs);
  save_settings(file_, {"vmc://b"});
  EXPECT_EQ(load_settings(file_), std::vector<std::string>{"vmc://b"});
  EXPECT_EQ(read_text_file(file_.string() + ".old"), theirs);
  write("{{{");
  save_settings(file_, {"vmc://c"});
  EXPECT_EQ(read_text_file(file_.string() + ".old"), theirs) << "that one stays";
  EXPECT_EQ(fs::file_size(file_.string() + ".old-2"), 3U);
}

TEST_F(Settings, ChangesAreMadeToWhatIsThereNow) {
  save_settings(file_, {"vmc://a"});
  write(R"({"version":1,"outputs":["vmc://a","vmc://b"],"more":{"of":"a later version"}})");
  update_settings(file_, [](std::vector<std::string>& urls) { urls.emplace_back("vmc://c"); });
  EXPECT_EQ(load_settings(file_), (std::vector<std::string>{"vmc://a", "vmc://b", "vmc://c"}));
  const std::string text = read_text_file(file_);
  EXPECT_NE(text.find("a later version"), std::string::npos) << text;
}

TEST_F(Settings, ManyAtOnceWaitForEachOther) {
  std::vector<std::thread> programs;
  for (int program = 0; program < 3; ++program) {
    programs.emplace_back([&, program] {
      for (int i = 0; i < 20; ++i) {
        const std::string url = "vmc://h" + std::to_string(100 * program + i);
        update_settings(file_, [&](std::vector<std::string>& urls) { urls.push_back(url); });
      }
    });
  }
  for (std::thread& program : programs) {
    program.join();
  }
  EXPECT_EQ(load_settings(file_).size(), 60U);
  update_settings(file_, [](std::vector<std::string>& urls) {
    for (int i = 0; i < 10; ++i) {
      urls.push_back("ws://h" + std::to_string(i));
    }
  });
  EXPECT_EQ(load_settings(file_).size(), 64U) << "what is too much for a run to read is not written";
  EXPECT_EQ(load_settings(file_).back(), "ws://h9");
}

TEST_F(Settings, ALinkToTheFileStaysOne) {
  const fs::path kept = folder_.path() / "dotfiles" / "live.json";
  fs::create_directories(file_.parent_path());
  fs::create_symlink("../../dotfiles/live.json", file_);
  for (const char* const url : {"vmc://a", "vmc://b"}) {  // the file is not there at first
    save_settings(file_, {url});
    EXPECT_TRUE(fs::is_symlink(file_));
    EXPECT_FALSE(fs::is_symlink(kept));
    EXPECT_EQ(load_settings(kept).front(), url);
  }
}

TEST_F(Settings, WhatCannotBeWrittenIsAnErrorAndTheOldFileStays) {
  save_settings(file_, {"vmc://a"});
  const std::vector<std::string> next = {"vmc://b"};
  EXPECT_THROW(save_settings(file_ / "below-a-file", next), Error);
  fs::create_directory(file_.parent_path() / "folder");
  EXPECT_THROW(save_settings(file_.parent_path() / "folder", next), Error);
  EXPECT_EQ(load_settings(file_).front(), "vmc://a");
  EXPECT_EQ(std::distance(fs::directory_iterator(file_.parent_path()), fs::directory_iterator()), 2);
}

}  // namespace
}  // namespace telemime
