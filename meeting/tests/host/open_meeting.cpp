// SPDX-License-Identifier: Apache-2.0
#include "open_meeting.h"

#include <mosquitto.h>

#include "meeting/transport/mqtt_connection.h"

namespace telemime::meeting::test_support {

OpenMeeting::OpenMeeting(const Change& change) {
  open(change);
}

void OpenMeeting::open(const Change& change) {
  HostOptions plan;
  plan.name = "studio";
  plan.title = "Blue room";
  plan.secrets = secrets();
  plan.port = 0;
  plan.broker.program = TELEMIME_MOSQUITTO;
  plan.broker.port = 0;
  plan.broker.web_port = 0;
  plan.looks = {"plain", "robot"};
  plan.file = [](const std::string& path) -> std::optional<WebContent> {
    if (path != "/room") {
      return std::nullopt;
    }
    return WebContent{std::make_shared<const std::string>("<p>the room</p>"), "text/html", "", false};
  };
  if (change) {
    change(plan);
  }
  host_ = std::make_unique<MeetingHost>(plan, [this](MeetingHost::Level, const std::string& words) {
    const std::lock_guard lock(mutex_);
    heard_ += words + "\n";
  });
}

std::string OpenMeeting::heard() const {
  const std::lock_guard lock(mutex_);
  return heard_;
}

WebReply OpenMeeting::ask(const std::string& body, const std::string& headers) const {
  RawClient client(host_->port());
  client.send(request_text(host_->port(), "/room/enter",
                           headers + "Content-Length: " + std::to_string(body.size()) + "\r\n", "POST") +
              body);
  return client.reply();
}

nlohmann::json OpenMeeting::enter(const nlohmann::json& question) const {
  nlohmann::json whole = question;
  whole["v"] = 1;
  const WebReply reply = ask(whole.dump());
  EXPECT_EQ(reply.status, 200) << reply.body;
  return nlohmann::json::parse(reply.status == 200 ? reply.body : "{}");
}

nlohmann::json OpenMeeting::newcomer() const {
  return enter({{"invite", speak()}});
}

namespace {

struct Said {
  int connected = -1;
  bool received = false;
};

}  // namespace

bool say(std::uint16_t port, const nlohmann::json& account, const std::string& topic,
         const std::string& payload) {
  const MqttLibrary library;
  Said said;
  mosquitto* const client = mosquitto_new(nullptr, true, &said);
  const auto user = account.at("user").get<std::string>();
  const auto password = account.at("password").get<std::string>();
  mosquitto_username_pw_set(client, user.c_str(), password.c_str());
  mosquitto_connect_callback_set(
      client, [](mosquitto*, void* self, int code) { static_cast<Said*>(self)->connected = code; });
  mosquitto_publish_callback_set(
      client, [](mosquitto*, void* self, int) { static_cast<Said*>(self)->received = true; });
  EXPECT_EQ(mosquitto_connect(client, "127.0.0.1", port, 60), MOSQ_ERR_SUCCESS);
  const auto turn = [client] { return mosquitto_loop(client, 10, 1) == MOSQ_ERR_SUCCESS; };
  comes_true([&] { return !turn() || said.connected >= 0; });
  if (said.connected == 0) {
    mosquitto_publish(client, nullptr, topic.c_str(), static_cast<int>(payload.size()), payload.data(), 1,
                      true);
    EXPECT_TRUE(comes_true([&] { return turn() && said.received; })) << topic;
  }
  mosquitto_disconnect(client);
  mosquitto_destroy(client);
  return said.connected == 0;
}

}  // namespace telemime::meeting::test_support
