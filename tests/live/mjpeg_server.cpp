// SPDX-License-Identifier: Apache-2.0
#include "live/mjpeg_server.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <utility>

namespace telemime::live_testing {
namespace {

using Steady = std::chrono::steady_clock;
constexpr auto kPoll = std::chrono::milliseconds(3);  // interval of checks for a new connection

bool send_all(int socket, const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t n = ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) {
      return false;
    }
    sent += static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

MjpegServer::MjpegServer(Protocol protocol) : protocol_(protocol) {
  listen();
  thread_ = std::thread([this] { serve(); });
}

MjpegServer::~MjpegServer() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
  drop(client_);
  drop(listener_);
}

std::string MjpegServer::url() const {
  return (protocol_ == Protocol::http ? "http" : "rtsp") + std::string("://127.0.0.1:") +
         std::to_string(port_) + "/video";
}

void MjpegServer::show(std::vector<std::string> parts, double rate) {
  const std::lock_guard lock(mutex_);
  parts_ = std::move(parts);
  rate_ = rate;
}

void MjpegServer::fall_silent() {
  show({}, 1.0);
}

void MjpegServer::hang_up() {
  const std::lock_guard lock(mutex_);
  hang_up_ = true;
}

void MjpegServer::unplug() {
  std::unique_lock lock(mutex_);
  plugged_ = false;
  changed_.wait(lock, [this] { return listener_ < 0; });  // from now on connections are refused
}

void MjpegServer::plug_in() {
  const std::lock_guard lock(mutex_);
  plugged_ = true;
}

int MjpegServer::connections() const {
  const std::lock_guard lock(mutex_);
  return connections_;
}

void MjpegServer::wait_for_connection(int number) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return connections_ >= number; });
}

void MjpegServer::listen() {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port_);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const general = reinterpret_cast<sockaddr*>(&address);
  if (::bind(listener_, general, size) != 0 || ::listen(listener_, 8) != 0 ||
      ::getsockname(listener_, general, &size) != 0) {
    throw std::runtime_error("no free port for the test camera");
  }
  port_ = ntohs(address.sin_port);
}

void MjpegServer::drop(int& socket) const {
  if (socket >= 0) {
    ::close(std::exchange(socket, -1));
  }
}

void MjpegServer::take_client() {
  pollfd wanted{listener_, POLLIN, 0};
  if (::poll(&wanted, 1, 0) <= 0) {
    return;
  }
  drop(client_);
  client_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  if (client_ < 0) {
    return;
  }
  const timeval patience{1, 0};
  ::setsockopt(client_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  ::setsockopt(client_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  const int yes = 1;
  ::setsockopt(client_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  std::string request;
  do {
    request.clear();
    while (request.find("\r\n\r\n") == std::string::npos) {
      char buffer[1024];
      const ssize_t n = ::recv(client_, buffer, sizeof buffer, 0);
      if (n <= 0) {
        drop(client_);
        return;
      }
      request.append(buffer, static_cast<std::size_t>(n));
    }
    if (!answer(request)) {
      drop(client_);
      return;
    }
  } while (protocol_ == Protocol::rtsp && !request.starts_with("PLAY "));
  const std::lock_guard lock(mutex_);
  ++connections_;
}

bool MjpegServer::answer(const std::string& request) {
  if (protocol_ == Protocol::http) {
    return send_all(client_,
                    "HTTP/1.0 200 OK\r\nCache-Control: no-cache\r\n"
                    "Content-Type: multipart/x-mixed-replace; boundary=part\r\n\r\n");
  }
  const std::size_t number = request.find("CSeq:");
  std::string text = "RTSP/1.0 200 OK\r\n" + request.substr(number, request.find("\r\n", number) - number) +
                     "\r\nSession: 1\r\n";
  if (request.starts_with("SETUP ")) {
    text += "Transport: RTP/AVP/TCP;unicast;interleaved=0-1\r\n";
  }
  const std::string body = request.starts_with("DESCRIBE ")
                               ? "v=0\r\no=- 1 1 IN IP4 127.0.0.1\r\ns=test\r\nt=0 0\r\n"
                                 "m=video 0 RTP/AVP 26\r\na=control:video\r\n"
                               : "";
  if (!body.empty()) {
    text += "Content-Type: application/sdp\r\nContent-Length: " + std::to_string(body.size()) + "\r\n";
  }
  return send_all(client_, text + "\r\n" + body);
}

// A JPEG image in one packet, as RFC 2435 has it: without its header, but with its two quantisation tables.
std::string MjpegServer::rtp_packet(const std::string& jpeg) {
  const auto word = [&](std::size_t at) {
    return 256U * static_cast<unsigned char>(jpeg.at(at)) + static_cast<unsigned char>(jpeg.at(at + 1));
  };
  const auto big_endian = [](std::uint32_t value, int bytes) {
    std::string text;
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
      text += static_cast<char>(value >> static_cast<unsigned>(shift));
    }
    return text;
  };
  std::string tables;
  std::string size;
  std::size_t at = 2;
  for (unsigned marker = 0; marker != 0xFFDA; at += 2 + word(at + 2)) {
    marker = word(at);
    if (marker == 0xFFDB) {  // each table follows its number
      for (std::size_t table = at + 5; table < at + 2 + word(at + 2); table += 65) {
        tables += jpeg.substr(table, 64);
      }
    } else if (marker == 0xFFC0) {
      size = big_endian(word(at + 7) / 8, 1) + big_endian(word(at + 5) / 8, 1);
    }
  }
  const auto ms =
      std::chrono::duration_cast<std::chrono::milliseconds>(Steady::now().time_since_epoch()).count();
  const std::string packet =
      big_endian(0x809A, 2) +  // version 2; the last one of an image; JPEG
      big_endian(packets_++, 2) + big_endian(static_cast<std::uint32_t>(90 * ms), 4) + big_endian(1, 4) +
      big_endian(0, 4) + big_endian(0x01FF, 2) +  // 4:2:0, own tables
      size + big_endian(static_cast<std::uint32_t>(tables.size()), 4) + tables + jpeg.substr(at);
  return "$" + big_endian(static_cast<std::uint32_t>(packet.size()), 3) + packet;
}

void MjpegServer::send_part(const std::string& part) {
  if (client_ < 0) {
    return;
  }
  const std::string bytes =
      protocol_ == Protocol::rtsp
          ? rtp_packet(part)
          : "--part\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(part.size()) +
                "\r\n\r\n" + part + "\r\n";
  if (!send_all(client_, bytes)) {
    drop(client_);
  }
}

void MjpegServer::serve() {
  std::size_t at = 0;
  auto due = Steady::now();
  while (true) {
    std::string part;
    bool plugged = true;
    {
      std::unique_lock lock(mutex_);
      if (changed_.wait_for(lock, kPoll, [this] { return stop_; })) {
        return;
      }
      plugged = plugged_;
      if (!plugged || std::exchange(hang_up_, false)) {
        drop(client_);
      }
      if (!plugged) {
        drop(listener_);
      }
      if (!parts_.empty() && Steady::now() >= due) {
        due = std::max(due, Steady::now() - std::chrono::milliseconds(100)) +
              std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(1.0 / rate_));
        part = parts_[at++ % parts_.size()];
      }
    }
    changed_.notify_all();
    if (!plugged) {
      continue;
    }
    if (listener_ < 0) {
      listen();
    }
    take_client();
    if (!part.empty()) {
      send_part(part);
    }
  }
}

std::vector<std::string> jpegs(const std::vector<cv::Mat>& pictures) {
  std::vector<std::string> files;
  for (const cv::Mat& picture : pictures) {
    std::vector<unsigned char> bytes;
    cv::imencode(".jpg", picture, bytes);
    files.emplace_back(bytes.begin(), bytes.end());
  }
  return files;
}

}  // namespace telemime::live_testing
