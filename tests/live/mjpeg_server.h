// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <string>
#include <thread>
#include <vector>

namespace telemime::live_testing {

/// A network camera for tests: Motion JPEG over HTTP (multipart/x-mixed-replace) or over RTSP (RTP in its TCP
/// connection, RFC 2326 and 2435; the parts are then JPEG files) at a free port of this computer. All changes
/// also apply to the open connection.
class MjpegServer {
 public:
  enum class Protocol { http, rtsp };

  explicit MjpegServer(Protocol protocol = Protocol::http);
  MjpegServer(const MjpegServer&) = delete;
  MjpegServer& operator=(const MjpegServer&) = delete;
  ~MjpegServer();

  std::string url() const;
  /// Sends these parts repeatedly, `rate` per second. They need not be images.
  void show(std::vector<std::string> parts, double rate);
  /// Keeps the connection open but sends nothing until show().
  void fall_silent();
  /// Closes the connection and accepts the next one.
  void hang_up();
  /// Closes the connection and refuses others until plug_in().
  void unplug();
  void plug_in();
  int connections() const;  ///< accepted so far
  /// Waits until this number of connections was accepted.
  void wait_for_connection(int number);

 private:
  void serve();
  void listen();
  void take_client();
  void drop(int& socket) const;
  bool answer(const std::string& request);
  void send_part(const std::string& part);
  std::string rtp_packet(const std::string& jpeg);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> parts_;
  double rate_ = 1.0;
  bool plugged_ = true;
  bool hang_up_ = false;
  bool stop_ = false;
  int connections_ = 0;

  const Protocol protocol_;

  // Used by the server's thread only.
  std::uint16_t packets_ = 0;  ///< of RTP
  std::uint16_t port_ = 0;
  int listener_ = -1;
  int client_ = -1;
  std::thread thread_;
};

/// The bytes of JPEG files.
std::vector<std::string> jpegs(const std::vector<cv::Mat>& pictures);

}  // namespace telemime::live_testing
