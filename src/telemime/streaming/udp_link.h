// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/asio/ip/udp.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "telemime/streaming/osc.h"
#include "telemime/streaming/person_motion.h"
#include "telemime/streaming/send_queue.h"

namespace telemime {

/// Sends poses as datagrams. UDP has no connections: a missing receiver is noticed only if the system reports
/// it, which it always does on this computer.
class UdpLink : public Link {
 public:
  /// `port`: the one that is meant when the URL names none.
  UdpLink(SendLoop& loop, const SendUrl& url, std::uint16_t port);

  void open() override;
  void person(const std::shared_ptr<const StreamHeader>& person) override;
  bool frame(const MotionFrame& raw, double taken) override;
  void close() noexcept override;

 protected:
  /// The datagrams of a frame; `motion` is nullptr while the person is lost.
  virtual std::vector<std::string> datagrams(const HumanoidSkeleton& skeleton, const HumanoidMotion* motion,
                                             const MotionFrame& frame) = 0;
  /// The last ones before the connection is closed; only after a frame of that person.
  virtual std::vector<std::string> farewell(const HumanoidSkeleton& /*skeleton*/) { return {}; }
  /// Bytes that a datagram to this receiver may have.
  std::size_t largest() const { return largest_; }

 private:
  void tell_of_unreachable(bool v4);
  void send(const std::string& datagram);
  [[noreturn]] void fail(const boost::system::error_code& error);
  void read_on();

  SendLoop& loop_;
  const std::string host_;
  const std::uint16_t port_;
  std::size_t largest_ = kLargestDatagram;
  std::optional<PersonMotion> motion_;
  std::shared_ptr<const StreamHeader> person_;         ///< of motion_
  std::int64_t frames_ = 0;                            ///< since the last connection
  bool told_ = false;                                  ///< the status says that frames arrive
  bool unreachable_ = false;                           ///< the computer was unreachable in the last attempt
  std::chrono::steady_clock::time_point believed_at_;  ///< when frames without a refusal count as received
  boost::asio::ip::udp::socket socket_;
  std::array<char, 512> rubbish_{};
};

/// Throws Error(usage) if the URL has a path, which these outputs do not have.
void check_no_path(const SendUrl& url, const std::string& example);

}  // namespace telemime
