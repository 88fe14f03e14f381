// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/jpeg.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

namespace telemime {
namespace {

using Bytes = std::vector<std::uint8_t>;

cv::Mat picture() {
  cv::Mat made(48, 64, CV_8UC3, cv::Scalar(20, 120, 220));
  cv::circle(made, {30, 20}, 12, {200, 40, 10}, cv::FILLED);
  return made;
}

Bytes file_of(const cv::Mat& image) {
  Bytes bytes;
  cv::imencode(".jpg", image, bytes);
  return bytes;
}

TEST(Jpeg, DecodesLikeOpenCv) {
  const Bytes bytes = file_of(picture());
  const cv::Mat decoded = decode_jpeg(bytes);
  const cv::Mat expected = cv::imdecode(bytes, cv::IMREAD_COLOR);
  ASSERT_EQ(decoded.size(), expected.size());
  ASSERT_EQ(decoded.type(), CV_8UC3);
  EXPECT_EQ(cv::norm(decoded, expected, cv::NORM_INF), 0.0);
}

TEST(Jpeg, ConvertsGreyToBgr) {
  cv::Mat grey;
  cv::cvtColor(picture(), grey, cv::COLOR_BGR2GRAY);
  EXPECT_EQ(decode_jpeg(file_of(grey)).type(), CV_8UC3);
}

TEST(Jpeg, AcceptsMissingHuffmanTables) {
  const Bytes whole = file_of(picture());  // written with the standard's tables
  Bytes bytes = {whole[0], whole[1]};
  std::size_t at = 2;
  int left_out = 0;
  while (whole[at + 1] != 0xDA) {  // start of scan
    const std::size_t size = 2 + 256U * whole[at + 2] + whole[at + 3];
    if (whole[at + 1] == 0xC4) {
      ++left_out;
    } else {
      bytes.insert(bytes.end(), whole.begin() + static_cast<std::ptrdiff_t>(at),
                   whole.begin() + static_cast<std::ptrdiff_t>(at + size));
    }
    at += size;
  }
  bytes.insert(bytes.end(), whole.begin() + static_cast<std::ptrdiff_t>(at), whole.end());
  ASSERT_GT(left_out, 0);
  const cv::Mat decoded = decode_jpeg(bytes);
  ASSERT_FALSE(decoded.empty());
  EXPECT_EQ(cv::norm(decoded, decode_jpeg(whole), cv::NORM_INF), 0.0);
}

TEST(Jpeg, RefusesTruncatedImages) {
  const Bytes whole = file_of(picture());
  for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
    EXPECT_TRUE(decode_jpeg({whole.data(), size}).empty()) << size;
  }
}

TEST(Jpeg, IgnoresTrailingBytes) {
  Bytes bytes = file_of(picture());
  bytes.resize(bytes.size() + 100, 0);
  EXPECT_FALSE(decode_jpeg(bytes).empty());
}

// Makes allocations of images fail for the scope.
class NoMemory final : public cv::MatAllocator {
 public:
  NoMemory() { cv::Mat::setDefaultAllocator(this); }
  ~NoMemory() override { cv::Mat::setDefaultAllocator(usual_); }
  NoMemory(const NoMemory&) = delete;
  NoMemory& operator=(const NoMemory&) = delete;

  cv::UMatData* allocate(int /*dims*/, const int* /*sizes*/, int /*type*/, void* /*data*/,
                         std::size_t* /*step*/, cv::AccessFlag /*flags*/,
                         cv::UMatUsageFlags /*usage*/) const override {
    throw cv::Exception(cv::Error::StsNoMem, "none", "allocate", "", 0);
  }
  bool allocate(cv::UMatData* /*data*/, cv::AccessFlag /*flags*/,
                cv::UMatUsageFlags /*usage*/) const override {
    return false;
  }
  void deallocate(cv::UMatData* data) const override { usual_->deallocate(data); }

 private:
  cv::MatAllocator* usual_ = cv::Mat::getDefaultAllocator();
};

TEST(Jpeg, ReleasesMemoryAfterFailure) {
  const Bytes bytes = file_of(picture());
  EXPECT_FALSE(decode_jpeg(bytes).empty());
  const NoMemory none;
  const std::size_t before = ::mallinfo2().uordblks;
  for (int i = 0; i < 500; ++i) {
    EXPECT_THROW(decode_jpeg(bytes), cv::Exception);
  }
  EXPECT_LT(::mallinfo2().uordblks, before + 1'000'000) << "sanitizers find it in their own way";
}

TEST(Jpeg, SurvivesAnyBytes) {
  const Bytes whole = file_of(picture());
  std::mt19937 random(1);
  int refused = 0;
  for (int round = 0; round < 2000; ++round) {
    Bytes bytes = whole;
    for (int i = 0; i < 1 + round % 20; ++i) {
      bytes[2 + random() % (bytes.size() - 2)] = static_cast<std::uint8_t>(random());
    }
    refused += decode_jpeg(bytes).empty() ? 1 : 0;
  }
  EXPECT_GT(refused, 100);
  EXPECT_TRUE(decode_jpeg({}).empty());
  EXPECT_TRUE(decode_jpeg(Bytes(5000, 'x')).empty());
}

}  // namespace
}  // namespace telemime
