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

/// A camera in the network for tests, as many of them are: Motion JPEG over HTTP (multipart/x-mixed-replace)
/// on this machine, at a port of its own. All changes act on the connection that is open, too.
class MjpegServer {
 public:
  MjpegServer();
  MjpegServer(const MjpegServer&) = delete;
  MjpegServer& operator=(const MjpegServer&) = delete;
  ~MjpegServer();

  std::string url() const;
  /// Sends these parts again and again, `rate` of them a second. They need not be pictures.
  void show(std::vector<std::string> parts, double rate);
  /// Keeps the connection and sends nothing more, until show().
  void fall_silent();
  /// Closes the connection; the next one is taken again.
  void hang_up();
  /// As if its plug was pulled: closes the connection and refuses others until plug_in().
  void unplug();
  void plug_in();
  int connections() const;  ///< taken so far
  /// Until so many were taken.
  void wait_for_connection(int number);

 private:
  void serve();
  void listen();
  void take_client();
  void drop(int& socket) const;
  void send_part(const std::string& part);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> parts_;
  double rate_ = 1.0;
  bool plugged_ = true;
  bool hang_up_ = false;
  bool stop_ = false;
  int connections_ = 0;

  // Of the server's thread.
  std::uint16_t port_ = 0;
  int listener_ = -1;
  int client_ = -1;
  std::thread thread_;
};

/// The bytes of JPEG files.
std::vector<std::string> jpegs(const std::vector<cv::Mat>& pictures);

}  // namespace telemime::live_testing
