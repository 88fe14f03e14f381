// SPDX-License-Identifier: Apache-2.0
#include "open_meeting.h"

#include <mosquitto.h>

#include "meeting/transport/mqtt_connection.h"

namespace telemime::meeting::test_support {

OpenMeeting::OpenMeeting(const Change& change) {
  open(change);
}

void OpenMeeting::open(const Change& change) {
  HostOptions options;
  options.name = "studio";
  options.title = "Blue room";
  options.secrets = secrets();
  options.port = 0;
  options.broker.program = TELEMIME_MOSQUITTO;
  options.broker.port = 0;
  options.broker.web_port = 0;
  options.looks = {"plain", "robot"};
  options.file = [](const std::string& path) -> std::optional<WebContent> {
    if (path != "/room") {
      return std::nullopt;
    }
    return WebContent{std::make_shared<const std::string>("<p>the meeting</p>"), "text/html", "", false};
  };
  if (change) {
    change(options);
  }
  host_ = std::make_unique<MeetingHost>(options, [this](const std::string& text) {
    const std::lock_guard lock(mutex_);
    reports_ += text + "\n";
  });
}

std::string OpenMeeting::reports() const {
  const std::lock_guard lock(mutex_);
  return reports_;
}

WebReply OpenMeeting::post(const std::string& body, const std::string& headers) const {
  RawClient client(host_->port());
  client.send(request_text(host_->port(), "/room/enter",
                           headers + "Content-Length: " + std::to_string(body.size()) + "\r\n", "POST") +
              body);
  return client.reply();
}

nlohmann::json OpenMeeting::log_in(const nlohmann::json& question) const {
  nlohmann::json whole = question;
  whole["v"] = 1;
  const WebReply reply = post(whole.dump());
  EXPECT_EQ(reply.status, 200) << reply.body;
  return nlohmann::json::parse(reply.status == 200 ? reply.body : "{}");
}

nlohmann::json OpenMeeting::join() const {
  return log_in({{"invite", speak()}});
}

namespace {

struct Published {
  int connected = -1;
  bool received = false;
};

}  // namespace

bool publish(std::uint16_t port, const nlohmann::json& account, const std::string& topic,
             const std::string& payload) {
  const MqttLibrary library;
  Published state;
  mosquitto* const client = mosquitto_new(nullptr, true, &state);
  const auto user = account.at("user").get<std::string>();
  const auto password = account.at("password").get<std::string>();
  mosquitto_username_pw_set(client, user.c_str(), password.c_str());
  mosquitto_connect_callback_set(
      client, [](mosquitto*, void* self, int code) { static_cast<Published*>(self)->connected = code; });
  mosquitto_publish_callback_set(
      client, [](mosquitto*, void* self, int) { static_cast<Published*>(self)->received = true; });
  EXPECT_EQ(mosquitto_connect(client, "127.0.0.1", port, 60), MOSQ_ERR_SUCCESS);
  const auto turn = [client] { return mosquitto_loop(client, 10, 1) == MOSQ_ERR_SUCCESS; };
  comes_true([&] { return !turn() || state.connected >= 0; });
  if (state.connected == 0) {
    mosquitto_publish(client, nullptr, topic.c_str(), static_cast<int>(payload.size()), payload.data(), 1,
                      true);
    EXPECT_TRUE(comes_true([&] { return turn() && state.received; })) << topic;
  }
  mosquitto_disconnect(client);
  mosquitto_destroy(client);
  return state.connected == 0;
}

}  // namespace telemime::meeting::test_support
