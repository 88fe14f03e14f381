// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/file_posix.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/optional/optional.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "telemime/streaming/web_origin.h"
#include "telemime/streaming/web_server.h"

namespace telemime {

/// The body of a response, for Beast: bytes, or a part of a file, which is read while it is sent.
struct WebBody {
  struct value_type {
    WebBytes bytes;                 ///< may be null
    boost::beast::file_posix file;  ///< from its position on
    std::uint64_t left = 0;         ///< bytes of the file
  };

  class writer {
   public:
    using const_buffers_type = boost::asio::const_buffer;
    using Part = boost::optional<std::pair<const_buffers_type, bool>>;

    template <bool is_request, class Fields>
    writer(boost::beast::http::header<is_request, Fields>& /*header*/, value_type& body) : body_(body) {}
    void init(boost::system::error_code& error) { error = {}; }
    Part get(boost::system::error_code& error);

   private:
    value_type& body_;
    std::vector<char> part_;  ///< of the file
  };
};

using WebRequest = boost::beast::http::request<boost::beast::http::empty_body>;
using WebResponse = boost::beast::http::response<WebBody>;

/// The response to any request except an accepted POST; nothing if the request asks for a WebSocket.
/// `request` is a complete header; `has_body` says whether a body follows, which is always refused. `local`
/// is the address at which the connection was accepted.
std::optional<WebResponse> web_answer(const WebRequest& request, bool has_body, const WebNames& names,
                                      std::string_view local, const WebHandlers& handlers);

/// Whether the request is a POST for handlers.post, which is called after the body was read. `post` gets path
/// and headers. False: web_answer() responds.
bool web_post(const WebRequest& request, const WebNames& names, std::string_view local,
              const WebHandlers& handlers, WebPost& post);

/// The response with `content` to that request.
WebResponse web_content(WebContent content, const WebRequest& request, const WebHandlers& handlers);

/// A plain text answer with a status; then the connection is closed.
WebResponse web_refusal(boost::beast::http::status status, const std::string& words);

}  // namespace telemime
