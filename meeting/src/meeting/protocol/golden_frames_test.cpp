// SPDX-License-Identifier: Apache-2.0
// The frames of data/frames/golden.json, which scripts/golden_frames.py packs with code of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "meeting/protocol/pose_detail.h"
#include "meeting/protocol/pose_frame.h"
#include "telemime/outputs/numbers.h"

namespace telemime::meeting {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Json = nlohmann::json;

Json golden() {
  std::ifstream file(std::string(TELEMIME_SOURCE_DIR) + "/data/frames/golden.json");
  return Json::parse(file);
}

Bytes from_hex(const std::string& text) {
  Bytes bytes(text.size() / 2);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::from_chars(text.data() + 2 * i, text.data() + 2 * i + 2, bytes[i], 16);
  }
  return bytes;
}

PoseFrame frame_of(const Json& meaning) {
  PoseFrame frame;
  const auto flags = meaning.at("flags").get<unsigned>();
  frame.tracked = (flags & 1U) != 0;
  frame.still = (flags & 2U) != 0;
  frame.session = meaning.at("session").get<std::uint16_t>();
  frame.sequence = meaning.at("sequence").get<std::uint32_t>();
  frame.captured = std::stoull(meaning.at("captured_us").get<std::string>());
  frame.mask = meaning.at("mask").get<std::uint32_t>();
  frame.hips = meaning.at("hips_mm").get<std::array<std::int16_t, 3>>();
  std::size_t next = 0;
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    if (frame.has(bone)) {
      frame.confidence[bone] = meaning.at("confidence").at(next).get<std::uint8_t>();
      const auto q = meaning.at("rotations").at(next).get<std::array<double, 4>>();
      frame.rotation[bone] = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
      ++next;
    }
  }
  EXPECT_EQ(next, meaning.at("rotations").size());
  return frame;
}

TEST(GoldenFrames, AreOfEveryKind) {
  const Json file = golden();
  EXPECT_EQ(file.at("bones").get<std::vector<std::string>>(),
            std::vector<std::string>(kHumanBoneNames.begin(), kHumanBoneNames.end()));
  std::set<std::string> names;
  std::set<std::string> faults;
  for (const Json& item : file.at("cases")) {
    EXPECT_TRUE(names.insert(item.at("name")).second) << item.at("name");
    EXPECT_NE(item.contains("frame"), item.contains("fault")) << item.at("name");
    if (item.contains("fault")) {
      faults.insert(item.at("fault"));
    }
  }
  EXPECT_EQ(faults, std::set<std::string>(kPoseFaultNames.begin(), kPoseFaultNames.end()));
  EXPECT_GE(names.size(), 12U + faults.size());
}

TEST(GoldenFrames, AreRead) {
  const Json file = golden();
  for (const Json& item : file.at("cases")) {
    SCOPED_TRACE(item.at("name").get<std::string>());
    const auto read = decode_pose_frame(from_hex(item.at("hex")));
    if (item.contains("fault")) {
      ASSERT_FALSE(read);
      EXPECT_EQ(name_of(read.fault()), item.at("fault").get<std::string>());
      continue;
    }
    ASSERT_TRUE(read) << name_of(read.fault());
    const PoseFrame meant = frame_of(item.at("frame"));
    EXPECT_EQ(read->tracked, meant.tracked);
    EXPECT_EQ(read->still, meant.still);
    EXPECT_EQ(read->session, meant.session);
    EXPECT_EQ(read->sequence, meant.sequence);
    EXPECT_EQ(read->captured, meant.captured);
    EXPECT_EQ(read->mask, meant.mask);
    EXPECT_EQ(read->hips, meant.hips);
    EXPECT_EQ(read->confidence, meant.confidence);
    for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
      EXPECT_LT(read->rotation[bone].angularDistance(meant.rotation[bone]) * kDegreesPerRadian, 0.01) << bone;
    }
  }
}

TEST(GoldenFrames, AreWritten) {
  const Json file = golden();
  int written = 0;
  for (const Json& item : file.at("cases")) {
    if (item.contains("frame") && item.value("written", true)) {
      EXPECT_EQ(encode(frame_of(item.at("frame"))), from_hex(item.at("hex"))) << item.at("name");
      ++written;
    }
  }
  EXPECT_GE(written, 12);
}

template <std::size_t n, class Number>
void read_all(const Json& from, std::array<Number, n>& to) {
  ASSERT_EQ(from.size(), n);
  std::copy(from.begin(), from.end(), to.begin());
}

PoseDetail detail_of(const Json& meaning) {
  PoseDetail detail;
  detail.session = meaning.at("session").get<std::uint16_t>();
  detail.sequence = meaning.at("sequence").get<std::uint32_t>();
  if (const Json& fingers = meaning.at("fingers"); !fingers.is_null()) {
    read_all(fingers, detail.fingers.emplace());
  }
  if (const Json& face = meaning.at("face"); !face.is_null()) {
    FaceDetail& read = detail.face.emplace();
    read.confidence = face.at("confidence").get<std::uint8_t>();
    read_all(face.at("gaze"), read.gaze);
    read_all(face.at("arkit"), read.arkit);
    read_all(face.at("vrm"), read.vrm);
  }
  return detail;
}

TEST(GoldenDetails, AreReadAndWritten) {
  std::set<std::string> faults;
  const Json file = golden();
  for (const Json& item : file.at("details")) {
    SCOPED_TRACE(item.at("name").get<std::string>());
    const Bytes bytes = from_hex(item.at("hex"));
    const auto read = decode_pose_detail(bytes);
    if (item.contains("fault")) {
      ASSERT_FALSE(read);
      EXPECT_EQ(name_of(read.fault()), item.at("fault").get<std::string>());
      faults.insert(item.at("fault"));
      continue;
    }
    ASSERT_TRUE(read) << name_of(read.fault());
    const PoseDetail meant = detail_of(item.at("detail"));
    EXPECT_EQ(read->session, meant.session);
    EXPECT_EQ(read->sequence, meant.sequence);
    EXPECT_EQ(read->fingers, meant.fingers);
    EXPECT_EQ(read->face, meant.face);
    if (item.value("written", true)) {
      EXPECT_EQ(encode(meant), bytes);
    }
    if (meant.fingers) {
      const FingerRotations rotations = rotations_of(*read->fingers);
      for (std::size_t bone = 0; bone < kFingerBoneCount; ++bone) {
        const auto q = item["detail"]["rotations"].at(kFingerBoneNames[bone]).get<std::array<double, 4>>();
        EXPECT_LT(rotations[bone].angularDistance(Eigen::Quaterniond(q[3], q[0], q[1], q[2])), 1e-6);
      }
    }
  }
  EXPECT_EQ(faults, std::set<std::string>(kDetailFaultNames.begin(), kDetailFaultNames.end()));
}

}  // namespace
}  // namespace telemime::meeting
