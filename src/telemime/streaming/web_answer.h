// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/span_body.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "telemime/streaming/web_file.h"
#include "telemime/streaming/web_origin.h"
#include "telemime/streaming/web_server.h"

namespace telemime {

using WebRequest = boost::beast::http::request<boost::beast::http::empty_body>;

/// What to do about a request.
struct WebAnswer {
  bool upgrade = false;  ///< it is a WebSocket; the rest is empty
  boost::beast::http::response<boost::beast::http::span_body<const char>> message;
  WebBytes bytes;                 ///< what message.body() looks at
  std::shared_ptr<WebFile> file;  ///< what follows the message, from `first` on, `left` bytes
  std::uint64_t first = 0;
  std::uint64_t left = 0;
  /// Not empty: first this, then finish().
  std::function<void(std::function<void(WebBytes)>)> later;
  /// Puts the bytes in that were waited for; none become a refusal.
  void finish(WebBytes made);
  /// Becomes web_refusal() instead, without bytes where none are to be sent.
  void refuse(boost::beast::http::status status, const std::string& words);

  bool head = false;  ///< no bytes are to be sent
};

/// Decides about anything but a POST that is taken. `request` is a whole header; `has_body` says whether
/// something follows it, which is always refused. `local` is the address at which the connection came in.
WebAnswer web_answer(const WebRequest& request, bool has_body, const WebNames& names, std::string_view local,
                     const WebHandlers& handlers);

/// Whether the request is a POST that handlers.post is to be asked about, once its body was read. `post`
/// gets path and headers. False: web_answer() knows.
bool web_post(const WebRequest& request, const WebNames& names, std::string_view local,
              const WebHandlers& handlers, WebPost& post);

/// What stands in `content`, for that request.
WebAnswer web_content(WebContent content, const WebRequest& request, const WebHandlers& handlers);

/// A plain text answer with a status; then the connection is closed.
WebAnswer web_refusal(boost::beast::http::status status, const std::string& words);

}  // namespace telemime
