// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "meeting/protocol/messages.h"
#include "meeting/protocol/publishing.h"
#include "meeting/protocol/topics.h"
#include "meeting/transport/mqtt_connection.h"
#include "telemime/streaming/person_motion.h"
#include "telemime/streaming/send_queue.h"

namespace telemime::meeting {

/// A tracker's place in a meeting.
struct MeetingOutput {
  MqttServer server;
  MeetingAddress meeting;
  std::string participant;
  std::string name;            ///< is_participant_name()
  std::string look = "plain";  ///< is_topic_segment()
  std::optional<int> seat;
  std::string warning;  ///< shown while there is no failure
};

/// A tracker in a meeting: retained presence and state, and poses at the rate of PublishPace, always the
/// newest.
class MeetingLink final : public Link {
 public:
  /// Throws Error(usage) when TLS cannot be used (tls.h).
  MeetingLink(SendLoop& loop, MeetingOutput output);

  void open() override;
  void person(const std::shared_ptr<const StreamHeader>& person) override;
  /// Returns false for a frame that waits for its slot; a newer one may replace it. If it was sent in the
  /// meantime, the next call returns true.
  bool frame(const MotionFrame& raw, double taken) override;
  void close() noexcept override;

 private:
  std::string topic(TopicKind kind) const;
  MqttMessage presence(bool here) const;
  MqttMessage state() const;
  std::string warnings() const;
  void on_message(const MqttMessage& message);
  void on_own_presence(const ParticipantPresence& presence);
  void on_own_absence();
  void count_participants();
  void drain();
  void send_when_due();
  void repeat_presence();

  SendLoop& loop_;
  const MeetingOutput output_;
  const std::uint16_t session_;
  const std::string pose_topic_;
  const std::array<MqttMessage, 2> last_messages_;
  MqttConnection connection_;
  boost::asio::steady_timer pose_timer_;
  boost::asio::steady_timer presence_timer_;
  double last_sent_ = 0.0;  ///< when anything was sent, s of the steady clock
  std::optional<PersonMotion> motion_;
  std::shared_ptr<const StreamHeader> person_;  ///< of motion_
  PublishPace pace_;
  Attendance attendance_;
  DetailPace detail_pace_;
  std::optional<DetailedFrame> waiting_;  ///< the newest frame, until it is sent
  std::uint32_t sequence_ = 0;
  std::uint64_t captured_ = 0;  ///< us, of the last frame sent
  int uncounted_ = 0;           ///< frames sent that frame() has not reported yet
  /// When our own presence came back, s of the steady clock: the broker accepts what we publish.
  std::optional<double> confirmed_;
  bool duplicate_ = false;  ///< another client takes part with our id
};

}  // namespace telemime::meeting
