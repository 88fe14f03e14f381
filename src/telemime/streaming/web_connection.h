// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/string_body.hpp>
#include <memory>
#include <optional>
#include <string>

#include "telemime/streaming/web_answer.h"
#include "telemime/streaming/web_hub.h"
#include "telemime/streaming/web_stream.h"

namespace telemime {

/// One HTTP connection: reads and answers one request after the other until one asks for a WebSocket, one is
/// invalid, or none arrives for too long. It exists as long as one of its operations is in progress. For the
/// server's thread only.
class WebConnection : public std::enable_shared_from_this<WebConnection> {
 public:
  WebConnection(std::shared_ptr<WebHub> hub, std::shared_ptr<void> ticket,
                boost::asio::ip::tcp::socket socket);
  /// Starts; call once.
  void start();

 private:
  void read();
  void read_body(WebPost post);
  void ask(WebPost post);
  void put_content(WebContent content);
  void answer(boost::system::error_code error);
  void upgrade();
  void respond(WebResponse answer);
  void write();
  void sent();
  void linger();

  std::shared_ptr<WebHub> hub_;
  std::shared_ptr<void> ticket_;
  WebStream stream_;
  boost::asio::steady_timer patience_;  ///< limits the wait for a response of a handler
  std::string local_;                   ///< the address at which it was accepted
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> body_;  ///< of a POST
  WebResponse answer_;
  std::optional<boost::beast::http::response_serializer<WebBody>> serializer_;  ///< of the response
  std::array<char, 4096> rest_{};
};

}  // namespace telemime
