// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace telemime {

/// An Ethernet frame of 1500 bytes minus the headers of IPv6 and UDP.
inline constexpr std::size_t kLargestDatagram = 1452;
/// Within this computer: less than the least size of the loopback device (16 KiB) that systems have.
inline constexpr std::size_t kLargestLocalDatagram = 16'000;

/// A message of Open Sound Control 1.0: an address with arguments.
class Osc {
 public:
  explicit Osc(std::string address);
  Osc& integer(std::int32_t value);
  Osc& number(double value);  ///< with 32 bits
  Osc& text(const std::string& value);

  const std::string& address() const { return address_; }
  std::size_t size() const;  ///< bytes
  void* content() const { return content_.get(); }

 private:
  std::string address_;
  std::unique_ptr<void, void (*)(void*)> content_;
};

/// As few bundles as there can be, each of at most `largest` bytes and with the first `common` messages.
std::vector<std::string> osc_bundles(const std::vector<Osc>& messages, std::size_t common,
                                     std::size_t largest);

/// A datagram for each message, for receivers that know no bundles.
std::vector<std::string> osc_single(const std::vector<Osc>& messages);

}  // namespace telemime
