// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/mqtt_key.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "telemime/core/errors.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::meeting {
namespace {

SendUrl parsed(const std::string& url) {
  return parse_url(url, "mqtt://h/a/b", UrlUser::taken);
}

class MqttKeys : public ::testing::Test {
 protected:
  std::string file(const std::string& content, mode_t mode = 0600) const {
    const std::string path = folder_.file("key.json");
    std::ofstream(path) << content;
    EXPECT_EQ(::chmod(path.c_str(), mode), 0);
    return path;
  }
  std::string refusal(const std::string& path) const {
    try {
      read_key_file(path);
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::usage);
      return e.what();
    }
    return "";
  }
  ScratchFolder folder_;
};

TEST_F(MqttKeys, AFileHoldsUserAndPassword) {
  const MqttKey key = read_key_file(file(R"({"user":"studio.p01","password":"s\u00e4cret","more":1})"));
  EXPECT_EQ(key.user, "studio.p01");
  EXPECT_EQ(key.password,
            "s\xc3\xa4"
            "cret");
  EXPECT_EQ(key.warning, "");
}

TEST_F(MqttKeys, AFileThatOthersMayReadIsWorthAWarning) {
  for (const mode_t mode : {0640, 0604, 0660, 0644}) {
    const std::string path = file(R"({"user":"u","password":"secret"})", mode);
    const std::string warning = read_key_file(path).warning;
    EXPECT_NE(warning.find("chmod 600 " + path), std::string::npos) << warning;
    EXPECT_EQ(warning.find("secret"), std::string::npos);
  }
  EXPECT_EQ(read_key_file(file(R"({"user":"u","password":"secret"})", 0400)).warning, "");
}

TEST_F(MqttKeys, OtherFilesAreRefusedWithoutTellingWhatIsInThem) {
  for (const std::string& content :
       {std::string(), std::string("secret"), std::string(R"({"user":"u"})"),
        std::string(R"({"password":"secret"})"), std::string(R"({"user":"","password":"secret"})"),
        std::string(R"({"user":"u","password":7})"), std::string(R"(["u","secret"])"),
        std::string("{\"user\":\"u\",\"password\":\"secret\\u0000\"}"),
        std::string("{\"user\":\"u\",\"password\":\"secret\xff\"}"),
        R"({"user":"u","password":"secret","x":")" + std::string(5000, 'x') + "\"}",
        R"({"user":"u","password":")" + std::string(300, 'x') + "\"}"}) {
    const std::string words = refusal(file(content));
    EXPECT_NE(words.find("key.json"), std::string::npos) << content;
    EXPECT_EQ(words.find("secret"), std::string::npos) << words;
  }
  EXPECT_NE(refusal(folder_.file("none")).find("none"), std::string::npos);
  EXPECT_NE(refusal(folder_.path().string()), "");
  EXPECT_NE(refusal("/dev/zero").find("it is no file"), std::string::npos);
  const std::string pipe = folder_.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(refusal(pipe).find("it is no file"), std::string::npos) << "and nobody waits for a writer";
}

TEST_F(MqttKeys, TheUrlComesFirstThenTheFileThenTheEnvironment) {
  const std::string path = file(R"({"user":"filed","password":"f"})");
  const auto user = [](const std::string& url, const char* environment) {
    const auto key = key_of(parsed(url), environment);
    return key ? key->user + ":" + key->password : "";
  };
  EXPECT_EQ(user("mqtt://h/a/b", nullptr), "");
  EXPECT_EQ(user("mqtt://h/a/b", ""), "");
  EXPECT_EQ(user("mqtt://h/a/b", "env:e:e"), "env:e:e");
  EXPECT_EQ(user("mqtt://h/a/b?key=" + path, "env:e"), "filed:f");
  EXPECT_EQ(user("mqtt://url:u@h/a/b?key=" + path, "env:e"), "url:u");
  EXPECT_EQ(user("mqtt://env@h/a/b", "env:e"), "env:e");
  EXPECT_EQ(user("mqtt://filed@h/a/b?key=" + path, "env:e"), "filed:f");
}

TEST_F(MqttKeys, AUserWithoutAPasswordIsToldSo) {
  for (const char* const environment :
       {static_cast<const char*>(nullptr), "other:secret", "secret", ":secret"}) {
    try {
      key_of(parsed("mqtt://studio.p01@h/a/b"), environment);
      ADD_FAILURE();
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(kMeetingKeyVariable), std::string::npos) << e.what();
      EXPECT_EQ(std::string(e.what()).find("secret"), std::string::npos) << e.what();
    }
  }
  EXPECT_THROW(key_of(parsed("mqtt://h/a/b"), "secret"), Error);
  EXPECT_THROW(key_of(parsed("mqtt://h/a/b?key=%"), nullptr), Error);
}

}  // namespace
}  // namespace telemime::meeting
