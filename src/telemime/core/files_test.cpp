// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>

#include "telemime/core/scratch_folder.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

mode_t mode_of(const fs::path& file) {
  struct stat about {};
  EXPECT_EQ(::stat(file.c_str(), &about), 0);
  return about.st_mode & 0777;
}

TEST(Files, AreReplacedWhole) {
  const ScratchFolder folder;
  const std::string file = folder.file("a");
  for (const std::string content : {"first, which is longer", "second", ""}) {
    write_whole_file(file, content);
    EXPECT_EQ(read_text_file(file), content);
    write_private_file(file, content, /*durable=*/!content.empty());
    EXPECT_EQ(read_small_file(file, content.size()).content, content);
    EXPECT_EQ(mode_of(file), 0600U);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1) << "nothing is left beside it";
  }
}

TEST(Files, AnErrorLeavesTheOldFile) {
  const ScratchFolder folder;
  const std::string inner = folder.file("folder");
  fs::create_directory(inner);
  for (const auto& write : {std::function([&] { write_whole_file(inner, "x"); }),
                            std::function([&] { write_private_file(inner, "x"); }),
                            std::function([&] { write_whole_file(inner + "/none/a", "x"); })}) {
    EXPECT_NE(error_of(ErrorKind::output, write).find("cannot write " + inner), std::string::npos);
  }
  EXPECT_TRUE(fs::is_directory(inner));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(Files, ThatCannotBeReadAreNamed) {
  const ScratchFolder folder;
  EXPECT_NE(error_of(ErrorKind::config, [&] { read_text_file(folder.path(), ErrorKind::config); })
                .find(folder.path().string() + " is a folder"),
            std::string::npos);
  EXPECT_NE(error_of(ErrorKind::input, [&] { read_text_file(folder.file("none")); }).find("No such file"),
            std::string::npos);
  EXPECT_THROW(read_small_file(folder.path(), 100), std::runtime_error);
  EXPECT_THROW(read_small_file("/dev/zero", 100), std::runtime_error);
  write_whole_file(folder.file("long"), "12345");
  EXPECT_THROW(read_small_file(folder.file("long"), 4), std::runtime_error);
  fs::create_symlink("long", folder.file("link"));
  EXPECT_EQ(read_small_file(folder.file("link"), 5).content, "12345");
  EXPECT_THROW(read_small_file(folder.file("link"), 5, SymbolicLinks::refuse), std::system_error);
}

TEST(Files, PrivateFoldersAreForTheirOwner) {
  const ScratchFolder folder;
  make_private_folders(folder.file("a/b"));
  EXPECT_EQ(mode_of(folder.file("a")), 0700U);
  EXPECT_EQ(mode_of(folder.file("a/b")), 0700U);
  write_whole_file(folder.file("file"), "");
  EXPECT_THROW(make_private_folders(folder.file("file/c")), Error);
}

}  // namespace
}  // namespace telemime
