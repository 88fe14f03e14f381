// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/pose_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "meeting/protocol/testing.h"
#include "telemime/core/random.h"
#include "telemime/outputs/numbers.h"

namespace telemime::meeting {
namespace {

using Bytes = std::vector<std::uint8_t>;

PoseFrame any_frame(Random& random) {
  PoseFrame frame;
  frame.tracked = random.below(4) != 0;
  frame.still = random.below(2) != 0;
  frame.session = static_cast<std::uint16_t>(1 + random.below(UINT16_MAX));
  frame.sequence = static_cast<std::uint32_t>(random.bits());
  frame.captured = random.bits();
  for (std::int16_t& coordinate : frame.hips) {
    coordinate = static_cast<std::int16_t>(random.below(65536));
  }
  if (!frame.tracked) {
    return frame;
  }
  frame.mask = static_cast<std::uint32_t>(random.below(1U << kHumanBoneCount));
  if (frame.mask == (1U << kHumanBoneCount) - 1U) {
    frame.mask = 1;
  }
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    if (frame.has(bone)) {
      frame.confidence[bone] = static_cast<std::uint8_t>(random.below(16));
      frame.rotation[bone] =
          Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
    }
  }
  return frame;
}

/// That two frames say the same, rotations to 0.01 degrees.
void expect_same(const PoseFrame& a, const PoseFrame& b) {
  EXPECT_EQ(a.tracked, b.tracked);
  EXPECT_EQ(a.still, b.still);
  EXPECT_EQ(a.session, b.session);
  EXPECT_EQ(a.sequence, b.sequence);
  EXPECT_EQ(a.captured, b.captured);
  EXPECT_EQ(a.hips, b.hips);
  ASSERT_EQ(a.mask, b.mask);
  EXPECT_EQ(a.confidence, b.confidence);
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    EXPECT_LT(a.rotation[bone].angularDistance(b.rotation[bone]) * kDegreesPerRadian, 0.01);
  }
}

TEST(PoseFrame, IsReadAsWritten) {
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const PoseFrame frame = any_frame(random);
    const Bytes bytes = encode(frame);
    EXPECT_LE(bytes.size(), kLongestPoseFrame);
    const auto back = decode_pose_frame(bytes);
    ASSERT_TRUE(back) << name_of(back.fault());
    expect_same(frame, *back);
  }
}

TEST(PoseFrame, HasTheDocumentedSizes) {
  PoseFrame frame;
  EXPECT_EQ(encode(frame).size(), 26U);
  frame.tracked = true;
  frame.mask = (1U << 13U) - 1U;
  EXPECT_EQ(encode(frame).size(), 111U);
  frame.mask = (1U << 18U) - 1U;
  EXPECT_EQ(encode(frame).size(), kLongestPoseFrame);
  EXPECT_EQ(kLongestPoseFrame, 143U);
}

TEST(PoseFrame, EveryOtherSizeIsRejected) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    Bytes bytes = encode(any_frame(random));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const auto cut = decode_pose_frame(std::span(bytes).first(size));
      ASSERT_FALSE(cut);
      EXPECT_EQ(cut.fault(), PoseFault::wrong_size);
    }
    for (int more = 0; more < 200; ++more) {
      bytes.push_back(static_cast<std::uint8_t>(random.bits()));
      const auto longer = decode_pose_frame(bytes);
      ASSERT_FALSE(longer);
      EXPECT_EQ(longer.fault(), PoseFault::wrong_size);
    }
  }
}

TEST(PoseFrame, EverySingleBitMayFlip) {
  Random random(3);
  std::set<PoseFault> faults;
  for (int i = 0; i < 60; ++i) {
    const PoseFrame frame = any_frame(random);
    Bytes bytes = encode(frame);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
      const auto read = decode_pose_frame(bytes);
      if (read) {
        const auto again = decode_pose_frame(encode(*read));  // what is read can be written
        ASSERT_TRUE(again);
        expect_same(*read, *again);
      } else {
        faults.insert(read.fault());
      }
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    }
  }
  EXPECT_GE(faults.size(), 6U);
}

TEST(PoseFrame, NoiseIsReadOrRejected) {
  Random random(4);
  int read = 0;
  for (int i = 0; i < 20'000; ++i) {
    const bool any_size = i % 2 == 0;
    Bytes bytes(any_size ? random.below(160) : kPoseFrameHead + 1 + 2 * kPackedRotationBytes);
    for (std::uint8_t& byte : bytes) {
      byte = static_cast<std::uint8_t>(random.bits());
    }
    if (!any_size) {  // a head that is well, or hardly anything would get past it
      bytes[0] = 1;
      bytes[1] |= 1U;
      bytes[2] |= 1U;
      std::fill(bytes.begin() + 16, bytes.begin() + 20, std::uint8_t{0});
      bytes[17] = 0x21;
    }
    const auto frame = decode_pose_frame(bytes);
    if (frame) {
      ++read;
      EXPECT_TRUE(decode_pose_frame(encode(*frame)));
    }
  }
  EXPECT_GT(read, 1000);
}

TEST(PoseFrame, InvalidFramesAreNotWritten) {
  const auto refused = [](const auto& change) {
    PoseFrame frame;
    frame.tracked = true;
    frame.mask = 1;
    change(frame);
    return !error_of([&] { encode(frame); }, ErrorKind::usage).empty();
  };
  EXPECT_FALSE(refused([](PoseFrame&) {}));
  EXPECT_TRUE(refused([](PoseFrame& f) { f.session = 0; }));
  EXPECT_TRUE(refused([](PoseFrame& f) { f.tracked = false; }));
  EXPECT_TRUE(refused([](PoseFrame& f) { f.mask = 1U << kHumanBoneCount; }));
  EXPECT_TRUE(refused([](PoseFrame& f) { f.mask = (1U << kHumanBoneCount) - 1U; }));
  EXPECT_TRUE(refused([](PoseFrame& f) { f.confidence[0] = 16; }));
  EXPECT_TRUE(refused([](PoseFrame& f) { f.rotation[0].coeffs().setZero(); }));
  EXPECT_TRUE(refused([](PoseFrame& f) { f.rotation[0].x() = std::numeric_limits<double>::quiet_NaN(); }));
}

}  // namespace
}  // namespace telemime::meeting
