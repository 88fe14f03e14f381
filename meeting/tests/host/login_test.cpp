// SPDX-License-Identifier: Apache-2.0
// Logging in to an open meeting: the answers of its server, and invalid requests.
#include <gtest/gtest.h>

#include <thread>

#include "broker/feeder.h"
#include "checks.h"
#include "meeting/transport/login.h"
#include "meeting/transport/senders.h"
#include "open_meeting.h"
#include "telemime/core/random.h"

namespace telemime::meeting::test_support {
namespace {

using Json = nlohmann::json;

TEST(Login, AnswerIsWhatThePageExpects) {
  OpenMeeting meeting;
  const WebReply reply = meeting.post(Json{{"v", 1}, {"invite", meeting.chair()}}.dump());
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.header("Content-Type"), "application/json");
  EXPECT_EQ(reply.header("Cache-Control"), "no-store");
  EXPECT_EQ(reply.header("Referrer-Policy"), "no-referrer");
  EXPECT_EQ(reply.header("X-Content-Type-Options"), "nosniff");
  const Json answer = Json::parse(reply.body);
  const std::string port = std::to_string(meeting.host().mqtt_port());
  const std::string web_port = std::to_string(meeting.host().web_port());
  EXPECT_EQ(answer.at("user"), "studio.p01");
  EXPECT_EQ(answer.at("participant"), "p01");
  EXPECT_EQ(answer.at("topic"), "r/home/studio");
  EXPECT_EQ(answer.at("mqtt"), "ws://localhost:" + web_port);
  EXPECT_EQ(answer.at("tcp"), "mqtt://localhost:" + port);
  EXPECT_EQ(answer.at("roles"), Json({"speak", "board", "chair"}));
  EXPECT_EQ(answer.at("looks"), Json({"plain", "robot"}));
  const Json watcher = meeting.log_in({{"invite", meeting.watch()}});
  EXPECT_EQ(watcher.at("participant"), nullptr);
  EXPECT_EQ(watcher.at("roles"), Json({"watch"}));
  EXPECT_FALSE(watcher.contains("return"));
}

TEST(Login, PageHasItsPolicy) {
  OpenMeeting meeting;
  const std::uint16_t port = meeting.host().port();
  const WebReply page = telemime::ask(port, "/room");
  EXPECT_EQ(page.body, "<p>the meeting</p>");
  EXPECT_EQ(
      page.header("Content-Security-Policy"),
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; font-src 'self'; "
      "worker-src 'self'; connect-src 'self' blob: data: https: ws://localhost:" +
          std::to_string(meeting.host().web_port()) +
          "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  EXPECT_EQ(telemime::ask(port, "/else").status, 404);
  EXPECT_EQ(telemime::ask(port, "/room/enter").status, 404) << "not by GET";
  EXPECT_EQ(telemime::ask(port, "/ws").status, 426);
}

TEST(Login, LinkNamesTheListeningAddress) {
  OpenMeeting meeting([](HostOptions& options) { options.address = "127.0.0.2"; });
  EXPECT_EQ(meeting.host().page(), "http://127.0.0.2:" + std::to_string(meeting.host().port()) + "/room");
  LinkLogin entry;
  entry.link = meeting.host().speak_link();
  EXPECT_EQ(log_in_by_link(entry).broker, "mqtt://127.0.0.2:" + std::to_string(meeting.host().mqtt_port()));
}

TEST(Login, RefusalsHaveTheirStatus) {
  OpenMeeting meeting([](HostOptions& options) { options.most = 1; });
  const auto status = [&](const Json& question, const std::string& headers) {
    return meeting.post(question.dump(), headers).status;
  };
  const std::string type = "Content-Type: application/json\r\n";
  const Json good = {{"v", 1}, {"invite", meeting.speak()}};
  EXPECT_EQ(status({{"v", 1}, {"invite", "guess"}}, type), 403);
  EXPECT_EQ(status({{"v", 2}, {"invite", meeting.speak()}}, type), 400);
  EXPECT_EQ(status(good, "Content-Type: text/plain\r\n"), 415);
  EXPECT_EQ(status(good, type + "Origin: http://evil.example\r\n"), 403);
  EXPECT_EQ(status(good, type + "Origin: null\r\n"), 403);
  EXPECT_EQ(status(good, type + "Sec-Fetch-Site: cross-site\r\n"), 403);
  EXPECT_EQ(status(good, type + "Origin: http://localhost:" + std::to_string(meeting.host().port()) + "\r\n"),
            200);
  EXPECT_EQ(status(good, type), 409);
}

TEST(Login, ProgramLogsInByALink) {
  OpenMeeting meeting;
  LinkLogin entry;
  entry.link = meeting.host().speak_link();
  ASSERT_TRUE(is_meeting_link(entry.link));
  EXPECT_EQ(without_secret(entry.link), meeting.host().page());
  const Credentials key = log_in_by_link(entry);
  EXPECT_EQ(key.broker, "mqtt://localhost:" + std::to_string(meeting.host().mqtt_port()));
  EXPECT_EQ(key.topic, "r/home/studio");
  EXPECT_EQ(key.participant, "p01");
  entry.rejoin = key.rejoin;
  EXPECT_EQ(log_in_by_link(entry).participant, "p01");
  entry.link = meeting.host().page();
  EXPECT_EQ(log_in_by_link(entry).participant, "p01") << "the token alone";
  entry.link = meeting.host().watch_link();
  entry.rejoin.clear();
  EXPECT_EQ(log_in_by_link(entry).participant, "");
  const auto refusal = [](const std::string& link) {
    LinkLogin wrong;
    wrong.link = link;
    return error_of([&] { log_in_by_link(wrong); });
  };
  EXPECT_NE(refusal(meeting.host().page() + "#k=secretguess").find("not valid"), std::string::npos);
  for (const std::string& bad :
       {std::string("http://127.0.0.1:9/room#k=secretguess"), meeting.host().page() + "#k=secretguess",
        meeting.host().page() + "#x=secretguess", std::string("mqtt://h/a/b#k=secretguess"),
        std::string("http://h/other#k=secretguess"), std::string("http://h:x/room#k=secretguess")}) {
    EXPECT_EQ(refusal(bad).find("secretguess"), std::string::npos) << refusal(bad);
    EXPECT_NE(refusal(bad), "") << bad;
  }
}

TEST(Login, ProgramsCanCancelIt) {
  OpenMeeting meeting;
  MeetingLogin login(meeting.host().speak_link(), /*watch=*/true, "", [] { return true; });
  const std::string error = error_of([&] { login.log_in(); });
  EXPECT_NE(error.find("it was cancelled"), std::string::npos) << error;
}

TEST(Login, TrackerTakesPartByALink) {
  OpenMeeting meeting;
  const Json watcher = meeting.log_in({{"invite", meeting.watch()}});
  const Subscriber subscriber(meeting.host().mqtt_port(), watcher.at("user"), watcher.at("password"));
  std::string link = meeting.host().speak_link();
  link.insert(link.find('#'), "?name=Ana&look=robot");
  const auto sender = make_sender(link, kAllSenderKinds);
  const Feeder feeder(*sender);
  EXPECT_TRUE(comes_true([&] { return subscriber.frames("p01").size() > 5; })) << sender->status().words;
  EXPECT_EQ(subscriber.json("p/p01/state").at("name"), "Ana");
  EXPECT_EQ(sender->status().url, meeting.host().page() + "?name=Ana&look=robot");
  EXPECT_EQ(sender->status().words.find(meeting.speak()), std::string::npos);
  const auto stranger = make_sender(meeting.host().page() + "#k=guess", kAllSenderKinds);
  ASSERT_TRUE(comes_true([&] { return stranger->status().state == SenderState::failed; }));
  EXPECT_NE(stranger->status().words.find("not valid"), std::string::npos) << stranger->status().words;
  const auto onlooker = make_sender(meeting.host().watch_link(), kAllSenderKinds);
  ASSERT_TRUE(comes_true([&] { return onlooker->status().state == SenderState::failed; }));
  EXPECT_NE(onlooker->status().words.find("only for watching"), std::string::npos);
}

TEST(Login, SimultaneousLoginsGetDifferentIds) {
  OpenMeeting meeting;
  std::vector<std::thread> threads;
  std::vector<Json> answers(24);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    threads.emplace_back([&meeting, &answers, i] { answers[i] = meeting.join(); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  std::set<std::string> ids;
  for (const Json& answer : answers) {
    ids.insert(answer.at("participant").get<std::string>());
    const std::string topic = "r/home/studio/p/" + answer.at("participant").get<std::string>() + "/chat";
    EXPECT_TRUE(publish(meeting.host().mqtt_port(), answer, topic, "hello")) << "the account works at once";
  }
  EXPECT_EQ(ids.size(), answers.size());
}

TEST(Login, InvalidRequestsAreHarmless) {
  OpenMeeting meeting;
  Random random(1);
  const std::string type = "Content-Type: application/json\r\n";
  std::map<int, int> answers;
  for (int i = 0; i < 10'000; ++i) {
    std::string body;
    const double kind = random.uniform();
    if (kind < 0.3) {
      body = Json{{"v", 1}, {"invite", "guess" + std::to_string(i)}}.dump();
    } else if (kind < 0.4) {
      body = std::string(static_cast<std::size_t>(random.uniform(4097, 20'000)), 'x');
    } else {
      body.resize(static_cast<std::size_t>(random.uniform(0, 300)));
      for (char& c : body) {
        c = static_cast<char>(static_cast<unsigned char>(random.uniform(0, 256)));
      }
    }
    ++answers[meeting.post(body, type).status];
  }
  EXPECT_EQ(answers[200], 0);
  EXPECT_GT(answers[413], 500);
  EXPECT_GT(answers[429], 5000) << "guessing is limited";
  EXPECT_EQ(answers[500], 0);
  EXPECT_EQ(answers[413] + answers[429] + answers[400] + answers[403], 10'000);
  EXPECT_EQ(telemime::ask(meeting.host().port(), "/room").status, 200);
  EXPECT_EQ(meeting.post(Json{{"v", 1}, {"invite", meeting.speak()}}.dump()).status, 200)
      << "guessing does not lock out those with a link";
}

}  // namespace
}  // namespace telemime::meeting::test_support
