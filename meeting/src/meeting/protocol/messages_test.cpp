// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/messages.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "meeting/protocol/testing.h"
#include "telemime/body/body.h"
#include "telemime/core/errors.h"
#include "telemime/core/random.h"
#include "telemime/outputs/testing_mutations.h"

namespace telemime::meeting {
namespace {

using Json = nlohmann::json;

const std::string kHash(64, 'a');

ParticipantState ana() {
  ParticipantState state;
  state.session = 1234;
  state.name = "Ana";
  state.seat = 3;
  state.avatar = AvatarByLook{"plain"};
  state.stature = 1.7;
  const HumanoidSkeleton skeleton = humanoid_skeleton(make_body(Shape{}));
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    state.bones[bone] = skeleton.position[bone];
  }
  return state;
}

/// The state message of Ana with one member changed.
std::string with(const std::string& member, const Json& value) {
  Json message = Json::parse(write_state(ana()));
  message[member] = value;
  return message.dump();
}

std::string refusal(const std::string& message) {
  const auto read = read_state(message);
  return read ? "" : read.fault().text;
}

TEST(Messages, StateIsReadAsWritten) {
  const ParticipantState sent = ana();
  const std::string text = write_state(sent);
  EXPECT_LT(text.size(), 1500U);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const auto read = read_state(text);
  ASSERT_TRUE(read) << read.fault().text;
  EXPECT_EQ(read->session, 1234);
  EXPECT_EQ(read->kind, ParticipantKind::tracker);
  EXPECT_EQ(read->name, "Ana");
  EXPECT_EQ(read->seat, 3);
  EXPECT_EQ(std::get<AvatarByLook>(read->avatar).look, "plain");
  EXPECT_NEAR(*read->stature, 1.7, 1e-9);
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    ASSERT_TRUE(read->bones[bone]);
    EXPECT_LT((*read->bones[bone] - *sent.bones[bone]).norm(), 2e-5);
  }
}

TEST(Messages, StateMayBeMinimal) {
  ParticipantState sent;
  sent.kind = ParticipantKind::browser;
  sent.name = "B";
  const Json message = Json::parse(write_state(sent));
  EXPECT_EQ(message,
            Json::parse(R"({"v":1,"session":1,"kind":"browser","name":"B","seat":null,"avatar":null})"));
  const auto read = read_state(message.dump());
  ASSERT_TRUE(read);
  EXPECT_FALSE(read->seat || read->stature || read->bones[0]);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(read->avatar));
}

TEST(Messages, AvatarMayBeAFile) {
  ParticipantState sent = ana();
  sent.avatar = AvatarFile{"https://example.org/a.vrm", kHash, kLargestAvatar};
  const auto read = read_state(write_state(sent));
  ASSERT_TRUE(read);
  const auto& file = std::get<AvatarFile>(read->avatar);
  EXPECT_EQ(file.url, "https://example.org/a.vrm");
  EXPECT_EQ(file.sha256, kHash);
  EXPECT_EQ(file.bytes, kLargestAvatar);
  const Json good = {{"url", "https://example.org/a.vrm"}, {"sha256", kHash}, {"bytes", 1}};
  EXPECT_EQ(refusal(with("avatar", good)), "");
  const auto changed = [&good](const char* member, const Json& value) {
    Json avatar = good;
    avatar[member] = value;
    return with("avatar", avatar);
  };
  for (const std::string& message :
       {changed("url", "http://example.org/a.vrm"), changed("url", "https://"),
        changed("url", "https://user:word@example.org/"), changed("url", "https://example.org/a b"),
        changed("url", "https://" + std::string(2041, 'x')), changed("url", 3), changed("sha256", "a"),
        changed("sha256", std::string(64, 'A')), changed("bytes", 0), changed("bytes", kLargestAvatar + 1),
        changed("bytes", 1.5), changed("bytes", "1"), with("avatar", "plain"),
        with("avatar", {{"look", "../x"}}), with("avatar", Json::object())}) {
    EXPECT_NE(refusal(message), "") << message;
  }
}

TEST(Messages, NamesHaveOneToFortyCharacters) {
  std::string hats;
  for (int i = 0; i < 40; ++i) {
    hats += "\xf0\x9f\x8e\xa9";
  }
  for (const std::string& good :
       {std::string("A"), std::string("J\xc3\xb6rg"), std::string(40, 'x'), hats, std::string("<b>")}) {
    EXPECT_TRUE(is_participant_name(good)) << good;
    EXPECT_EQ(refusal(with("name", good)), "");
  }
  for (const std::string& bad : {std::string(), std::string(41, 'x'), hats + "x", std::string("a\nb"),
                                 std::string("a\0b", 3), std::string("\x7f"), std::string("\xc2\x85")}) {
    EXPECT_FALSE(is_participant_name(bad)) << bad;
    EXPECT_NE(refusal(with("name", bad)), "") << bad;
  }
  EXPECT_FALSE(is_participant_name("\xff"));
  EXPECT_FALSE(is_participant_name("\xc3"));
  EXPECT_FALSE(is_participant_name("\xed\xa0\x80")) << "half of a pair is no character";
  EXPECT_TRUE(is_participant_name("\xc2\xa0"));
}

TEST(Messages, ViolationsAreRejectedWithAReason) {
  for (const auto& [member, value] : {std::pair<std::string, Json>{"v", 2},
                                      {"v", "1"},
                                      {"session", 0},
                                      {"session", 65536},
                                      {"session", -1},
                                      {"session", 1.5},
                                      {"kind", "god"},
                                      {"name", nullptr},
                                      {"bones", 3}}) {
    EXPECT_NE(refusal(with(member, value)).find("'" + member + "'"), std::string::npos) << member << value;
  }
  for (const char* const place : {"[1,2]", "[1,2,3,4]", "[1,2,\"3\"]", "[1,2,11]", "{\"x\":1}", "null"}) {
    EXPECT_NE(refusal(with("bones", {{"hips", Json::parse(place)}})).find("bone"), std::string::npos)
        << place;
  }
  EXPECT_NE(refusal("[]").find("JSON"), std::string::npos);
  EXPECT_NE(refusal("").find("bytes"), std::string::npos);
  EXPECT_NE(refusal(std::string(4097, ' ')).find("bytes"), std::string::npos);
  EXPECT_NE(refusal(std::string(2000, '[') + std::string(2000, ']')).find("nested"), std::string::npos);
  EXPECT_NE(refusal("{\"v\":1,\"name\":\"\xff\"}").find("JSON"), std::string::npos);
  const std::string text = write_state(ana());
  EXPECT_EQ(refusal(text + std::string(kLongestState - text.size(), ' ')), "");
}

TEST(Messages, UnknownAndUselessMembersAreIgnored) {
  EXPECT_EQ(refusal(with("mood", "good")), "");
  EXPECT_EQ(refusal(with("bones", {{"tail", "wags"}})), "");
  EXPECT_EQ(refusal(with("session", 7.0)), "") << "3.0 is 3 to JavaScript";
  for (const Json& seat : {Json(-1), Json(100), Json(1.5), Json("3"), Json(nullptr)}) {
    EXPECT_FALSE(read_state(with("seat", seat))->seat) << seat;
  }
  for (const Json& stature : {Json(0), Json(99), Json("tall"), Json(nullptr)}) {
    EXPECT_FALSE(read_state(with("stature", stature))->stature) << stature;
  }
}

TEST(Messages, InvalidValuesAreNotWritten) {
  const auto refused = [](const auto& change) {
    ParticipantState state = ana();
    change(state);
    return !error_of([&] { write_state(state); }, ErrorKind::usage).empty();
  };
  EXPECT_FALSE(refused([](ParticipantState&) {}));
  EXPECT_TRUE(refused([](ParticipantState& s) { s.session = 0; }));
  EXPECT_TRUE(refused([](ParticipantState& s) { s.name = "\n"; }));
  EXPECT_TRUE(refused([](ParticipantState& s) { s.name = "\xff"; }));
  EXPECT_TRUE(refused([](ParticipantState& s) { s.seat = -1; }));
  EXPECT_TRUE(refused([](ParticipantState& s) { s.seat = kMostSeats; }));
  EXPECT_TRUE(refused([](ParticipantState& s) { s.stature = 4.0; }));
  EXPECT_TRUE(refused([](ParticipantState& s) { s.avatar = AvatarByLook{"a/b"}; }));
  EXPECT_TRUE(refused([](ParticipantState& s) { s.avatar = AvatarFile{"https://x", kHash, 0}; }));
  EXPECT_TRUE(refused([](ParticipantState& s) { s.bones[0]->x() = std::nan(""); }));
  EXPECT_THROW(write_presence({true, 0}), Error);
}

TEST(Messages, PresenceIsHereOrNot) {
  EXPECT_EQ(write_presence({true, 7, {}}), R"({"v":1,"here":true,"session":7})");
  EXPECT_EQ(write_presence({true, 7, 1.25}), R"({"v":1,"here":true,"session":7,"every":1.25})");
  EXPECT_EQ(read_presence(R"({"v":1,"here":true,"session":7,"every":1.25})")->every, 1.25);
  for (const char* none : {"0.4", "61", "-1", "null", "\"2\"", "[1]"}) {
    const auto read = read_presence(R"({"v":1,"here":true,"session":7,"every":)" + std::string(none) + "}");
    ASSERT_TRUE(read) << none;
    EXPECT_FALSE(read->every) << none;
  }
  EXPECT_THROW(write_presence({true, 7, 0.1}), Error);
  for (const bool here : {false, true}) {
    const auto read = read_presence(write_presence({here, 65535}));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->here, here);
    EXPECT_EQ(read->session, 65535);
  }
  EXPECT_TRUE(read_presence(R"({"v":1,"here":true,"session":7,"more":[1]})"));
  for (const char* const bad :
       {"", "{}", "null", R"({"here":true,"session":7})", R"({"v":1,"session":7})",
        R"({"v":1,"here":1,"session":7})", R"({"v":1,"here":true})", R"({"v":1,"here":true,"session":0})",
        R"({"v":1,"here":true,"session":7}x)"}) {
    EXPECT_FALSE(read_presence(bad)) << bad;
  }
  EXPECT_FALSE(read_presence(R"({"v":1,"here":true,"session":7})" + std::string(256, ' ')));
}

TEST(Messages, DamagedMessagesAreReadOrRejected) {
  const std::string valid = write_state(ana());
  Random random(5);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::string text = testing_mutations::mutated(valid, random);
    const auto read = read_state(text);
    refused += read ? 0 : 1;
    if (read) {
      EXPECT_TRUE(read_state(write_state(*read)));
    } else {
      EXPECT_NE(read.fault().text, "");
    }
    read_presence(text);
  }
  EXPECT_GT(refused, 100);
}

TEST(Attendance, CountsThosePresent) {
  Attendance here;
  EXPECT_EQ(here.count(), 0U);
  here.update("a", write_presence({true, 1}));
  here.update("b", write_presence({true, 1}));
  here.update("a", write_presence({true, 1}));
  EXPECT_EQ(here.count(), 2U);
  EXPECT_TRUE(here.has("a"));
  here.update("a", write_presence({false, 1}));
  EXPECT_EQ(here.count(), 1U);
  EXPECT_FALSE(here.has("a"));
  here.update("b", "");
  EXPECT_EQ(here.count(), 0U);
}

TEST(Attendance, EndOfAnOlderSessionRemovesNobody) {
  Attendance here;
  here.update("a", write_presence({true, 1}));
  here.update("a", write_presence({true, 2}));
  here.update("a", write_presence({false, 1}));
  EXPECT_TRUE(here.has("a"));
  here.update("a", write_presence({false, 2}));
  EXPECT_FALSE(here.has("a"));
  here.update("b", write_presence({false, 1}));
  EXPECT_EQ(here.count(), 0U);
}

TEST(Attendance, InvalidMessageChangesNothing) {
  Attendance here;
  here.update("a", write_presence({true, 1}));
  here.update("a", "gone!");
  here.update("b", "{}");
  EXPECT_EQ(here.count(), 1U);
}

TEST(Attendance, IsBounded) {
  Attendance here;
  for (int i = 0; i < 3000; ++i) {
    here.update(std::to_string(i), write_presence({true, 1}));
  }
  EXPECT_EQ(here.count(), 1000U);
}

}  // namespace
}  // namespace telemime::meeting
