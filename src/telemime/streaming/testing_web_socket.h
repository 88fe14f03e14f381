// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "telemime/streaming/testing_web.h"

namespace telemime {

inline constexpr const char* upgrade_headers =
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

/// The client's side of a WebSocket, written from RFC 6455 alone, so that it can also break its rules.
class SocketClient : public RawClient {
 public:
  enum Opcode : std::uint8_t { more = 0, text = 1, binary = 2, close = 8, ping = 9, pong = 10 };
  struct Frame {
    std::uint8_t opcode = 0;
    bool last = true;
    std::string payload;
    /// Of a close frame: why; 1005 when it does not say.
    int code() const {
      return payload.size() < 2
                 ? 1005
                 : static_cast<unsigned char>(payload[0]) * 256 + static_cast<unsigned char>(payload[1]);
    }
  };

  explicit SocketClient(std::uint16_t port, const std::string& headers = "", int receive_buffer = 0,
                        const char* address = "127.0.0.1")
      : RawClient(port, address, receive_buffer) {
    RawClient::send(request_text(port, "/ws", upgrade_headers + headers));
    handshake_ = reply(/*head=*/true);
    // The answer to that key is the example of RFC 6455, section 1.3.
    if (handshake_.status != 101 ||
        handshake_.header("Sec-WebSocket-Accept") != "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=") {
      throw std::runtime_error("no WebSocket: " + handshake_.head);
    }
  }
  const WebReply& handshake() const { return handshake_; }

  bool send_frame(std::uint8_t opcode, std::string_view payload, bool last = true, bool masked = true) const {
    std::string frame(1, static_cast<char>((last ? 0x80 : 0) | opcode));
    const char mask_bit = masked ? '\x80' : '\0';
    const std::size_t size = payload.size();
    if (size < 126) {
      frame += static_cast<char>(mask_bit | static_cast<char>(size));
    } else if (size < 65536) {
      frame += static_cast<char>(mask_bit | 126);
      frame += {static_cast<char>(size >> 8), static_cast<char>(size)};
    } else {
      frame += static_cast<char>(mask_bit | 127);
      for (int shift = 56; shift >= 0; shift -= 8) {
        frame += static_cast<char>(size >> shift);
      }
    }
    constexpr std::string_view mask = "\x37\xfa\x21\x3d";
    frame += masked ? mask : "";
    for (std::size_t i = 0; i < size; ++i) {
      frame += static_cast<char>(payload[i] ^ (masked ? mask[i % 4] : 0));
    }
    return RawClient::send(frame);
  }
  bool say(std::string_view words) const { return send_frame(text, words); }

  /// Nothing when the other side closes the connection.
  std::optional<Frame> frame() {
    if (!fill(2)) {
      return std::nullopt;
    }
    const std::string start = take(2);
    Frame result;
    result.opcode = static_cast<std::uint8_t>(start[0] & 0x0F);
    result.last = (start[0] & 0x80) != 0;
    std::uint64_t size = static_cast<std::uint8_t>(start[1]);  // a server does not mask
    const std::size_t extra = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (!fill(extra)) {
      return std::nullopt;
    }
    if (extra > 0) {
      size = 0;
      for (const char c : take(extra)) {
        size = size * 256 + static_cast<std::uint8_t>(c);
      }
    }
    if (!fill(size)) {
      return std::nullopt;
    }
    result.payload = take(size);
    return result;
  }
  /// The next whole message; pings are answered. Nothing when the connection ends.
  std::optional<Frame> message() {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    Frame whole;
    while (std::optional<Frame> part = frame()) {
      if (std::chrono::steady_clock::now() > deadline) {
        throw std::runtime_error("the server says nothing but pings");
      }
      if (part->opcode == ping) {
        send_frame(pong, part->payload);
      } else if (part->opcode == close) {
        return std::nullopt;
      } else if (part->opcode != pong) {
        whole.opcode = part->opcode == more ? whole.opcode : part->opcode;
        whole.payload += part->payload;
        if (part->last) {
          return whole;
        }
      }
    }
    return std::nullopt;
  }
  /// What the next message says; "(closed)" when there is none.
  std::string heard() {
    const std::optional<Frame> next = message();
    return next ? next->payload : "(closed)";
  }
  /// Reads on until the connection is closed, and answers as it should; why, or 0 when the server did not
  /// say.
  int close_code() {
    while (const std::optional<Frame> next = frame()) {
      if (next->opcode == close) {
        send_frame(close, next->payload.substr(0, 2));
        return next->code();
      }
    }
    return 0;
  }

 private:
  WebReply handshake_;
};

}  // namespace telemime
