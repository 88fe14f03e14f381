// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// A receiver of Open Sound Control and of the VMC protocol for the tests, written from the specifications
/// (OSC 1.0; VMC protocol 3.1) and sharing nothing with the sender.
namespace telemime::testing_osc {

struct OscMessage {
  std::string path;
  std::string types;  ///< without the comma
  std::vector<std::int32_t> ints;
  std::vector<float> floats;
  std::vector<std::string> strings;
};

/// Reads big-endian fields, each padded to a multiple of four bytes.
class OscReader {
 public:
  explicit OscReader(std::string_view bytes) : bytes_(bytes) {}

  std::uint32_t word() {
    std::uint32_t value = 0;
    if (bytes_.size() < 4) {
      ADD_FAILURE() << "a number is cut off";
      bytes_ = {};
      return 0;
    }
    for (int i = 0; i < 4; ++i) {
      value = value << 8 | static_cast<unsigned char>(bytes_[static_cast<std::size_t>(i)]);
    }
    bytes_.remove_prefix(4);
    return value;
  }

  std::string text() {
    const std::size_t end = bytes_.find('\0');
    if (end == std::string_view::npos) {
      ADD_FAILURE() << "a string has no end";
      bytes_ = {};
      return {};
    }
    const std::string found(bytes_.substr(0, end));
    const std::size_t padded = end / 4 * 4 + 4;
    EXPECT_LE(padded, bytes_.size());
    EXPECT_EQ(bytes_.substr(end, padded - end).find_first_not_of('\0'), std::string_view::npos);
    bytes_.remove_prefix(std::min(padded, bytes_.size()));
    return found;
  }

  std::string_view taken(std::size_t size) {
    EXPECT_LE(size, bytes_.size());
    const std::string_view found = bytes_.substr(0, size);
    bytes_.remove_prefix(found.size());
    return found;
  }

  bool at_end() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
};

/// All messages of a datagram, those of bundles in order.
inline std::vector<OscMessage> parse_osc(std::string_view datagram) {
  EXPECT_EQ(datagram.size() % 4, 0U);
  OscReader reader(datagram);
  OscMessage message;
  message.path = reader.text();
  std::vector<OscMessage> messages;
  if (message.path == "#bundle") {
    EXPECT_EQ(reader.word(), 0U);
    EXPECT_EQ(reader.word(), 1U) << "the time tag says \"at once\"";
    while (!reader.at_end()) {
      for (const OscMessage& inner : parse_osc(reader.taken(reader.word()))) {
        messages.push_back(inner);
      }
    }
    return messages;
  }
  const std::string types = reader.text();
  EXPECT_EQ(types.substr(0, 1), ",");
  message.types = types.substr(1);
  for (const char type : message.types) {
    if (type == 'i') {
      message.ints.push_back(static_cast<std::int32_t>(reader.word()));
    } else if (type == 'f') {
      message.floats.push_back(std::bit_cast<float>(reader.word()));
    } else if (type == 's') {
      message.strings.push_back(reader.text());
    } else {
      ADD_FAILURE() << "an argument of type " << type;
    }
  }
  EXPECT_TRUE(reader.at_end());
  return {message};
}

/// Where a bone is, as a receiver gets it: x y z, then the quaternion x y z w; Unity's frame.
struct UnityPlace {
  std::vector<float> position;
  std::vector<float> rotation;
};

/// What a Marionette knows after a frame.
struct Marionette {
  std::vector<std::int32_t> ok;
  float time = -1.0F;
  UnityPlace root;
  std::map<std::string, UnityPlace> bones;
  std::map<std::string, float> blends;
  bool applied = false;  ///< the expressions are complete

  void take(const OscMessage& message) {
    const auto place = [&message] {
      EXPECT_EQ(message.types, "sfffffff") << message.path;
      const auto& f = message.floats;
      return f.size() == 7 ? UnityPlace{{f[0], f[1], f[2]}, {f[3], f[4], f[5], f[6]}} : UnityPlace{};
    };
    if (message.path == "/VMC/Ext/OK") {
      EXPECT_EQ(message.types, "iiii");
      ok = message.ints;
    } else if (message.path == "/VMC/Ext/T") {
      EXPECT_EQ(message.types, "f");
      time = message.floats.at(0);
    } else if (message.path == "/VMC/Ext/Root/Pos") {
      root = place();
      EXPECT_EQ(message.strings.at(0), "root");
    } else if (message.path == "/VMC/Ext/Bone/Pos") {
      bones[message.strings.at(0)] = place();
    } else if (message.path == "/VMC/Ext/Blend/Val") {
      EXPECT_EQ(message.types, "sf");
      EXPECT_FALSE(applied) << "a value after the expressions were applied";
      blends[message.strings.at(0)] = message.floats.at(0);
    } else if (message.path == "/VMC/Ext/Blend/Apply") {
      EXPECT_EQ(message.types, "");
      applied = true;
    } else {
      ADD_FAILURE() << "the protocol has no " << message.path;
    }
  }
};

}  // namespace telemime::testing_osc
