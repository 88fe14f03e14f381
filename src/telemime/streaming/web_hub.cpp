// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_hub.h"

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>

#include "telemime/streaming/web_client.h"

namespace telemime {
namespace {

/// docs/live-protocol.md.
std::string error_message(const std::string& words) {
  const nlohmann::json message = {{"type", "message"}, {"level", "error"}, {"words", words}};
  return message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

WebHub::WebHub(const WebServerOptions& options, WebHandlers handlers, WebNames names,
               std::shared_ptr<WebDoor> door, std::shared_ptr<boost::asio::ssl::context> tls)
    : options_(options),
      handlers_(std::move(handlers)),
      names_(std::move(names)),
      door_(std::move(door)),
      tls_(std::move(tls)) {}

std::shared_ptr<void> WebHub::ticket() {
  if (*connections_ >= options_.most_clients + options_.more_connections) {
    return nullptr;
  }
  ++*connections_;
  return {connections_.get(), [open = connections_](std::size_t*) { --*open; }};
}

bool WebHub::crowded() const {
  return *connections_ > options_.most_clients + options_.more_connections * 3 / 4;
}

std::optional<std::uint64_t> WebHub::join(const std::shared_ptr<WebClient>& client, bool from_here) {
  if (clients_.size() >= options_.most_clients) {
    return std::nullopt;
  }
  clients_[++last_id_] = client;
  const std::lock_guard lock(mutex_);
  turned_off_[last_id_];
  if (from_here) {
    from_here_.insert(last_id_);
  }
  return last_id_;
}

void WebHub::leave(std::uint64_t id) {
  if (clients_.erase(id) == 0) {
    return;
  }
  const std::lock_guard lock(mutex_);
  turned_off_.erase(id);
  from_here_.erase(id);
}

void WebHub::leave_all() {
  while (!clients_.empty()) {
    leave(clients_.begin()->first);
  }
  held_.clear();
}

std::size_t WebHub::clients() const {
  const std::lock_guard lock(mutex_);
  return turned_off_.size();
}

bool WebHub::wanted(int topic) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(turned_off_.begin(), turned_off_.end(),
                     [topic](const auto& client) { return topic == 0 || !client.second.contains(topic); });
}

bool WebHub::from_here(std::uint64_t client) const {
  const std::lock_guard lock(mutex_);
  return from_here_.contains(client);
}

std::vector<std::string> WebHub::greeting(std::uint64_t id) const {
  try {
    return handlers_.opened ? handlers_.opened(id) : std::vector<std::string>();
  } catch (const std::exception& error) {
    return {error_message(error.what())};
  } catch (...) {
    return {error_message("The program could not greet this page.")};
  }
}

std::optional<std::string> WebHub::answer(std::uint64_t id, std::string_view text) const {
  try {
    return handlers_.text ? handlers_.text(id, text) : std::nullopt;
  } catch (const std::exception& error) {
    return error_message(error.what());
  } catch (...) {
    return error_message("The program could not answer this.");
  }
}

bool WebHub::put(WebMessage message) {
  const std::lock_guard lock(mutex_);
  inbox_.push(std::move(message));
  return !std::exchange(drain_is_due_, true);
}

void WebHub::drain() {
  WebQueue arrived;
  {
    const std::lock_guard lock(mutex_);
    std::swap(arrived, inbox_);
    inbox_ = WebQueue(std::numeric_limits<std::size_t>::max());
    drain_is_due_ = false;
  }
  // A copy: a client whose queue is full leaves during the loop.
  const std::map<std::uint64_t, std::weak_ptr<WebClient>> clients = clients_;
  while (const std::optional<WebMessage> message = arrived.pop()) {
    for (const auto& [id, weak] : clients) {
      if (const std::shared_ptr<WebClient> client = weak.lock()) {
        client->push(*message);
      }
    }
  }
}

void WebHub::set_topic(std::uint64_t client, int topic, bool on) {
  const auto found = clients_.find(client);
  if (const std::shared_ptr<WebClient> known = found == clients_.end() ? nullptr : found->second.lock()) {
    known->set_topic(topic, on);
    const std::lock_guard lock(mutex_);
    if (on) {
      turned_off_[client].erase(topic);
    } else {
      turned_off_[client].insert(topic);
    }
  }
}

}  // namespace telemime
