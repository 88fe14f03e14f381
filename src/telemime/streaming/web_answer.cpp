// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_answer.h"

#include <algorithm>
#include <boost/beast/websocket/rfc6455.hpp>
#include <exception>

#include "telemime/streaming/web_file.h"
#include "telemime/streaming/web_path.h"

namespace telemime {
namespace {

namespace http = boost::beast::http;

constexpr std::size_t longest_target = 4096;
constexpr std::string_view socket_path = "/ws";

std::string_view view(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

/// What a page of this server may do. glTF loaders fetch blob: and data: addresses of textures. The
/// WebSocket's address is listed because 'self' does not cover ws: in every browser. Inline styles are
/// allowed because they cannot run code.
std::string content_policy(std::string_view host, std::string_view connects = {}) {
  std::string policy =
      "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; "
      "font-src 'self' data:; media-src 'self' blob:; worker-src 'self' blob:; manifest-src 'self'; "
      "connect-src 'self' blob: data:";
  if (!host.empty()) {
    policy.append(" ws://").append(host);
  }
  policy.append(connects.empty() ? "" : " ").append(connects);
  return policy + "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

void set_guards(WebResponse& message, const std::string& policy) {
  message.set("Content-Security-Policy", policy);
  message.set("X-Content-Type-Options", "nosniff");
  message.set("X-Frame-Options", "DENY");
  message.set("Referrer-Policy", "no-referrer");
  message.set("Cross-Origin-Resource-Policy", "same-origin");
  message.set("Cross-Origin-Opener-Policy", "same-origin");
}

/// A file name that needs no quoting in a header.
std::string plain_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(),
      [](char c) {
        return (c < 'a' || c > 'z') && (c < 'A' || c > 'Z') && (c < '0' || c > '9') && c != '.' && c != '-' &&
               c != '_';
      },
      '_');
  return name;
}

/// Responds with the part of the file that the headers ask for.
void set_file(WebResponse& message, WebFile file, const WebRequest& request) {
  WebRange range{WebRange::Kind::whole, 0, file.size};
  const std::string_view condition = view(request[http::field::if_range]);
  if (request.method() != http::verb::head && request.count(http::field::range) == 1 &&
      (condition.empty() || condition == file.tag)) {
    range = web_range(view(request[http::field::range]), file.size);
  }
  const std::string size = std::to_string(file.size);
  message.set(http::field::accept_ranges, "bytes");
  message.set(http::field::etag, file.tag);
  if (range.kind == WebRange::Kind::part) {
    message.result(http::status::partial_content);
    message.set(http::field::content_range, "bytes " + std::to_string(range.first) + "-" +
                                                std::to_string(range.first + range.size - 1) + "/" + size);
  } else if (range.kind == WebRange::Kind::nothing) {
    message.result(http::status::range_not_satisfiable);
    message.set(http::field::content_range, "bytes */" + size);
  }
  message.content_length(range.size);
  boost::system::error_code error;
  file.file.seek(range.first, error);
  message.body() = {nullptr, std::move(file.file), error ? 0 : range.size};
}

void set_bytes(WebResponse& message, WebBytes bytes) {
  message.content_length(bytes ? bytes->size() : 0);
  message.body().bytes = std::move(bytes);
}

}  // namespace

WebBody::writer::Part WebBody::writer::get(boost::system::error_code& error) {
  // Bytes that are read at a time; other connections are served in between.
  constexpr std::size_t kLongestPart = 128 * 1024;
  error = {};
  if (body_.bytes && !body_.bytes->empty()) {
    return {{boost::asio::buffer(*body_.bytes), false}};
  }
  if (body_.left == 0) {
    return boost::none;
  }
  part_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kLongestPart, body_.left)));
  const std::size_t count = body_.file.read(part_.data(), part_.size(), error);
  if (count == 0 && !error) {
    error = http::error::partial_message;  // the file was truncated: closing the connection shows it
  }
  if (error) {
    return boost::none;
  }
  body_.left -= count;
  return {{boost::asio::buffer(part_.data(), count), body_.left > 0}};
}

WebResponse web_content(WebContent content, const WebRequest& request, const WebHandlers& handlers) {
  WebResponse message;
  message.result(content.status);
  message.version(request.version());
  message.keep_alive(request.keep_alive());
  const std::string_view host = view(request[http::field::host]);
  set_guards(message, handlers.policy ? handlers.policy(host) : content_policy(host, content.connects));
  message.set(http::field::content_type, content.type);
  message.set(http::field::cache_control,
              content.immutable ? "public, max-age=31536000, immutable" : "no-store");
  if (!content.file_name.empty()) {
    message.set(http::field::content_disposition,
                "attachment; filename=\"" + plain_name(std::move(content.file_name)) + "\"");
  }
  if (content.file.empty()) {
    set_bytes(message, std::move(content.bytes));
  } else if (std::optional<WebFile> file = open_web_file(content.file)) {
    set_file(message, std::move(*file), request);
  } else {
    return web_refusal(http::status::not_found, "This file is no longer there.");
  }
  return message;
}

namespace {

WebResponse ask_handler(const WebRequest& request, const std::string& path, const WebHandlers& handlers) {
  std::optional<WebContent> content;
  try {
    content = handlers.get ? handlers.get(path) : std::nullopt;
  } catch (const std::exception& error) {
    return web_refusal(http::status::internal_server_error,
                       std::string("The program could not answer this: ") + error.what());
  } catch (...) {
    return web_refusal(http::status::internal_server_error, "The program could not answer this.");
  }
  return content ? web_content(std::move(*content), request, handlers)
                 : web_refusal(http::status::not_found, "There is nothing here: " + path);
}

/// Why the request may come from another web site or from a page under a false name; nothing if it cannot.
std::optional<WebResponse> stranger(const WebRequest& request, const WebNames& names,
                                    std::string_view local) {
  if (request.count(http::field::host) != 1) {
    return web_refusal(http::status::bad_request, "The request must have one Host header.");
  }
  if (!names.host(view(request[http::field::host]), local)) {
    return web_refusal(
        http::status::forbidden,
        "This program does not answer to that name (header Host).\n"
        "Use http://localhost and its port, or start it with that name as an additional host.");
  }
  const std::size_t origins = request.count(http::field::origin);
  if (origins > 1 || (origins == 1 && !names.origin(view(request[http::field::origin]), local))) {
    return web_refusal(http::status::forbidden,
                       "Pages of other web sites may not use this program (header Origin).");
  }
  // Browsers send this header even without an Origin. Links from other sites are fine: they navigate.
  const std::string_view site = view(request["Sec-Fetch-Site"]);
  if ((site == "cross-site" || site == "same-site") && view(request["Sec-Fetch-Mode"]) != "navigate") {
    return web_refusal(http::status::forbidden,
                       "Pages of other web sites may not use this program (header Sec-Fetch-Site).");
  }
  return std::nullopt;
}

}  // namespace

WebResponse web_refusal(http::status status, const std::string& words) {
  WebResponse message;
  message.result(status);
  message.version(11);
  message.keep_alive(false);
  set_guards(message, content_policy({}));
  message.set(http::field::content_type, "text/plain; charset=utf-8");
  message.set(http::field::cache_control, "no-store");
  set_bytes(message, std::make_shared<const std::string>(words + "\n"));
  return message;
}

bool web_post(const WebRequest& request, const WebNames& names, std::string_view local,
              const WebHandlers& handlers, WebPost& post) {
  if (!handlers.post || request.method() != http::verb::post || stranger(request, names, local) ||
      request.target().size() > longest_target) {
    return false;
  }
  std::optional<std::string> path = web_path(view(request.target()));
  if (!path || *path == socket_path) {
    return false;
  }
  post.path = std::move(*path);
  post.type = view(request[http::field::content_type]);
  post.host = view(request[http::field::host]);
  return true;
}

std::optional<WebResponse> web_answer(const WebRequest& request, bool has_body, const WebNames& names,
                                      std::string_view local, const WebHandlers& handlers) {
  if (std::optional<WebResponse> refusal = stranger(request, names, local)) {
    return refusal;
  }
  const bool head = request.method() == http::verb::head;
  if (!head && request.method() != http::verb::get) {
    WebResponse refusal = web_refusal(http::status::method_not_allowed, "Only GET and HEAD are supported.");
    refusal.set(http::field::allow, "GET, HEAD");
    return refusal;
  }
  if (has_body) {
    return web_refusal(http::status::payload_too_large, "A request must have no body.");
  }
  if (request.target().size() > longest_target) {
    return web_refusal(http::status::uri_too_long, "The address is too long.");
  }
  const std::optional<std::string> path = web_path(view(request.target()));
  if (!path) {
    return web_refusal(http::status::bad_request, "The address is malformed.");
  }
  if (*path != socket_path) {
    WebResponse answer = ask_handler(request, *path, handlers);
    if (head) {
      answer.body() = {};  // the headers stay
    }
    return answer;
  }
  if (boost::beast::websocket::is_upgrade(request)) {
    return std::nullopt;
  }
  WebResponse refusal = web_refusal(http::status::upgrade_required, "This address is for WebSockets.");
  refusal.set(http::field::upgrade, "websocket");
  if (head) {
    refusal.body() = {};
  }
  return refusal;
}

}  // namespace telemime
