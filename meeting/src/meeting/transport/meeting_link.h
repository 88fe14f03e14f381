// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "meeting/protocol/attendance.h"
#include "meeting/protocol/messages.h"
#include "meeting/protocol/pose_frame.h"
#include "meeting/protocol/publish_pace.h"
#include "meeting/protocol/topics.h"
#include "meeting/transport/mqtt_connection.h"
#include "telemime/streaming/person_motion.h"
#include "telemime/streaming/send_queue.h"

namespace telemime::meeting {

/// Where and as whom to take part.
struct MeetingOutput {
  MqttServer server;
  MeetingAddress meeting;
  std::string participant;
  std::string name;            ///< is_participant_name()
  std::string look = "plain";  ///< is_topic_segment()
  std::optional<int> seat;
  std::string warning;  ///< for the user, while all is well otherwise
};

/// A participant of a room: presence and state for those who come later, poses as often as publish_pace.h
/// allows, always the newest.
class MeetingLink final : public Link {
 public:
  /// Throws Error(usage) when TLS cannot be used (mqtt_tls.h).
  MeetingLink(SendLoop& loop, MeetingOutput output);

  void open() override;
  void person(const std::shared_ptr<const StreamHeader>& person) override;
  /// False for a frame that waits for its time; the next one may take its place. One that was sent in the
  /// meantime is counted with the next.
  bool frame(const MotionFrame& raw, double taken) override;
  void close() noexcept override;

 private:
  std::string topic(TopicKind kind) const;
  MqttMessage presence(bool here) const;
  MqttMessage state() const;
  std::string words() const;
  void hear(const MqttMessage& message);
  void hear_of_oneself(const ParticipantPresence& presence);
  void hear_that_we_are_gone();
  void count_participants();
  void drain();
  void send_when_due();
  void breathe_when_silent();

  SendLoop& loop_;
  const MeetingOutput output_;
  const std::uint16_t session_;
  const std::string pose_topic_;
  const std::array<MqttMessage, 2> last_words_;
  MqttConnection connection_;
  boost::asio::steady_timer timer_;
  boost::asio::steady_timer breath_;
  double said_ = 0.0;  ///< when something was said last, s of the steady clock
  std::optional<PersonMotion> motion_;
  std::shared_ptr<const StreamHeader> person_;  ///< whose motion_ is
  PublishPace pace_;
  Attendance here_;
  std::optional<PoseFrame> waiting_;  ///< the newest frame, until it is sent
  std::uint32_t sequence_ = 0;
  std::uint64_t captured_ = 0;  ///< us, of the last frame that was sent
  int uncounted_ = 0;           ///< frames that were sent and not yet told by frame()
  /// When our presence came back, s of the steady clock: what we publish is taken.
  std::optional<double> confirmed_;
  bool twin_ = false;  ///< somebody else takes part under our name
};

}  // namespace telemime::meeting
