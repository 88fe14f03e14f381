// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/avatar_folder.h"

#include <gtest/gtest.h>

#include <fstream>

#include "telemime/core/errors.h"
#include "telemime/core/scratch_folder.h"

namespace telemime {
namespace {

class Avatars : public ::testing::Test {
 protected:
  void put(const std::string& name) const { std::ofstream(folder_.file(name)) << "glTF"; }
  /// The name of the file for a web path; "" if there is none.
  std::string at(const std::string& path) const {
    const auto content = AvatarFolder(folder_.path()).file(path);
    return content ? content->file.filename().string() : "";
  }
  ScratchFolder folder_;
};

TEST_F(Avatars, LightVariantIsSentIfPresent) {
  put("x.vrm");
  put("x-light.vrm");
  EXPECT_EQ(at("/avatars/x.vrm"), "x.vrm");
  EXPECT_EQ(at("/avatars/x-light.vrm"), "x-light.vrm");
}

TEST_F(Avatars, MissingLightVariantFallsBack) {
  put("x.vrm");
  EXPECT_EQ(at("/avatars/x-light.vrm"), "x.vrm");
  EXPECT_EQ(at("/avatars/y-light.vrm"), "");
  EXPECT_EQ(at("/avatars/x-light-light.vrm"), "");
}

TEST_F(Avatars, OtherFilesAreNotServed) {
  put("x.vrm");
  put("notes.txt");
  EXPECT_EQ(AvatarFolder(folder_.path()).looks(), std::vector<std::string>{"x"});
  for (const char* const path : {"/avatars/X.vrm", "/avatars/notes.txt", "/avatars/../x.vrm", "/avatars/.vrm",
                                 "/avatars/-light.vrm", "/avatars.vrm", "/x.vrm", ""}) {
    EXPECT_EQ(at(path), "") << path;
  }
  EXPECT_FALSE(AvatarFolder("").file("/avatars/x.vrm"));
  EXPECT_THROW(AvatarFolder(folder_.path() / "none"), Error);
}

TEST_F(Avatars, AnyFileNameMakesALook) {
  const std::string longest(40, 'a');
  for (const char* const name :
       {"AvatarSample_A.vrm", "My  Robot!.VRM", "\xe7\xa7\x81.vrm", "x.vrm", "X.vrm", "x-2.vrm"}) {
    put(name);
  }
  put(longest + ".vrm");
  put(longest + "b.vrm");
  const AvatarFolder avatars(folder_.path());
  EXPECT_EQ(avatars.looks(),
            (std::vector<std::string>{std::string(30, 'a') + "-2", std::string(32, 'a'), "avatar",
                                      "avatarsample_a", "my-robot", "x", "x-2", "x-3"}));
  EXPECT_EQ(at("/avatars/my-robot.vrm"), "My  Robot!.VRM");
  EXPECT_EQ(at("/avatars/avatar.vrm"), "\xe7\xa7\x81.vrm");
  EXPECT_EQ(at("/avatars/x.vrm"), "x.vrm");
  EXPECT_EQ(at("/avatars/x-2.vrm"), "x-2.vrm");
  EXPECT_EQ(at("/avatars/x-3.vrm"), "X.vrm");
}

TEST_F(Avatars, SecondFolderAddsAndReplaces) {
  put("x.vrm");
  put("y.vrm");
  ScratchFolder more;
  for (const char* const name : {"y.vrm", "z.vrm"}) {
    std::ofstream(more.file(name)) << "glTF";
  }
  const AvatarFolder both(folder_.path(), more.path());
  EXPECT_EQ(both.looks(), (std::vector<std::string>{"x", "y", "z"}));
  EXPECT_EQ(both.file("/avatars/y.vrm")->file.parent_path(), more.path());
  EXPECT_EQ(both.file("/avatars/x.vrm")->file.parent_path(), folder_.path());
  EXPECT_THROW(AvatarFolder(folder_.path(), more.path() / "none"), Error);
}

TEST_F(Avatars, OwnLookIsSentToWeakComputersToo) {
  put("robot.vrm");
  put("robot-light.vrm");
  const ScratchFolder more;
  std::ofstream(more.file("robot.vrm")) << "glTF";
  const AvatarFolder both(folder_.path(), more.path());
  EXPECT_EQ(both.looks(), std::vector<std::string>{"robot"});
  EXPECT_EQ(both.file("/avatars/robot-light.vrm")->file, more.path() / "robot.vrm");
}

TEST_F(Avatars, NameThatSoundsLikeALightVariantIsALook) {
  put("Traffic Light.vrm");
  EXPECT_EQ(AvatarFolder(folder_.path()).looks(), std::vector<std::string>{"traffic-light"});
  EXPECT_EQ(at("/avatars/traffic-light.vrm"), "Traffic Light.vrm");
}

TEST_F(Avatars, LooksBeginWithThePlainOne) {
  for (const char* const name : {"robot", "plain", "plain-light", "casual"}) {
    put(name + std::string(".vrm"));
  }
  EXPECT_EQ(AvatarFolder(folder_.path()).looks(), (std::vector<std::string>{"plain", "casual", "robot"}));
}

}  // namespace
}  // namespace telemime
