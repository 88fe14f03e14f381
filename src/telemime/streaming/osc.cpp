// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/osc.h"

#include <lo/lo.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <utility>

namespace telemime {
namespace {

constexpr std::size_t kBundleHead = 16;  // "#bundle" and a time tag
constexpr std::size_t kSizeField = 4;
constexpr lo_timetag kAtOnce = {0U, 1U};

/// liblo allocates by malloc and returns a copy of the bytes.
std::string taken(void* bytes, std::size_t size) {
  const std::unique_ptr<void, decltype(&std::free)> owner(bytes, std::free);
  if (bytes == nullptr) {
    throw std::bad_alloc();
  }
  return {static_cast<const char*>(bytes), size};
}

std::string bundle_of(const std::vector<const Osc*>& messages) {
  // lo_bundle_free never releases the copies of the paths (liblo 0.31).
  const std::unique_ptr<void, decltype(&lo_bundle_free_recursive)> bundle(lo_bundle_new(kAtOnce),
                                                                          lo_bundle_free_recursive);
  if (!bundle) {
    throw std::bad_alloc();
  }
  for (const Osc* message : messages) {
    lo_bundle_add_message(bundle.get(), message->address().c_str(), message->content());
  }
  std::size_t size = 0;
  void* const bytes = lo_bundle_serialise(bundle.get(), nullptr, &size);
  return taken(bytes, size);
}

}  // namespace

Osc::Osc(std::string address) : address_(std::move(address)), content_(lo_message_new(), lo_message_free) {
  if (!content_) {
    throw std::bad_alloc();
  }
  lo_message_incref(content_.get());  // our reference; a bundle adds its own and releases it
}

Osc& Osc::integer(std::int32_t value) {
  lo_message_add_int32(content_.get(), value);
  return *this;
}

Osc& Osc::number(double value) {
  lo_message_add_float(content_.get(), static_cast<float>(value + 0.0));  // + 0.0: no -0
  return *this;
}

Osc& Osc::text(const std::string& value) {
  lo_message_add_string(content_.get(), value.c_str());
  return *this;
}

std::size_t Osc::size() const {
  return lo_message_length(content_.get(), address_.c_str());
}

std::vector<std::string> osc_bundles(const std::vector<Osc>& messages, std::size_t common,
                                     std::size_t largest) {
  std::vector<const Osc*> bundle;
  std::size_t size = kBundleHead;
  const auto add = [&](const Osc& message) {
    bundle.push_back(&message);
    size += kSizeField + message.size();
  };
  const auto begin = [&] {
    bundle.clear();
    size = kBundleHead;
    std::for_each(messages.begin(), messages.begin() + static_cast<std::ptrdiff_t>(common), add);
  };
  begin();
  std::vector<std::string> datagrams;
  for (std::size_t i = common; i < messages.size(); ++i) {
    if (size + kSizeField + messages[i].size() > largest && bundle.size() > common) {
      datagrams.push_back(bundle_of(bundle));
      begin();
    }
    add(messages[i]);
  }
  datagrams.push_back(bundle_of(bundle));
  return datagrams;
}

std::vector<std::string> osc_single(const std::vector<Osc>& messages) {
  std::vector<std::string> datagrams;
  for (const Osc& message : messages) {
    std::size_t size = 0;
    void* const bytes = lo_message_serialise(message.content(), message.address().c_str(), nullptr, &size);
    datagrams.push_back(taken(bytes, size));
  }
  return datagrams;
}

}  // namespace telemime
