// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/image_sequence.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "telemime/capture/prepare_opencv.h"
#include "telemime/capture/testing.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

class ImageSequenceTest : public ::testing::Test {
 protected:
  ImageSequenceTest() { prepare_opencv(); }

  void write_image(const std::string& name, const cv::Mat& image) const {
    ASSERT_TRUE(cv::imwrite(scratch_.file(name), image)) << name;
  }
  void write_numbered(const std::string& name, int number) const {
    write_image(name, testing::numbered_picture(number));
  }

  /// The numbers in the frames of an input.
  static std::vector<int> numbers(Source& source) {
    std::vector<int> all;
    while (std::optional<Frame> frame = source.next()) {
      EXPECT_EQ(frame->image.type(), CV_8UC3);
      EXPECT_EQ(frame->image.size(), cv::Size(source.info().width, source.info().height));
      all.push_back(testing::number_of(frame->image));
    }
    return all;
  }

  ScratchFolder scratch_;
};

TEST(NaturalOrder, EveryPairIsOrderedOneWayOnly) {
  const std::vector<std::string> sorted = {"",
                                           "1",
                                           "01",
                                           "2",
                                           "10",
                                           "a",
                                           "a0",
                                           "a00",
                                           "a1",
                                           "a1b",
                                           "a2",
                                           "a02",
                                           "a10",
                                           "a100",
                                           "a99999999999999999999998",
                                           "a99999999999999999999999",
                                           "b",
                                           "frame2.png",
                                           "frame10.png",
                                           "frame10b.png",
                                           "z"};
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    for (std::size_t j = 0; j < sorted.size(); ++j) {
      EXPECT_EQ(natural_less(sorted[i], sorted[j]), i < j) << sorted[i] << " and " << sorted[j];
    }
  }
}

TEST_F(ImageSequenceTest, ReadsAFolderInNaturalOrder) {
  for (const int number : {10, 2, 1, 9}) {
    write_numbered("frame" + std::to_string(number) + ".png", number);
  }
  testing::write_bytes(scratch_.file("readme.txt"), "not an image");
  const std::unique_ptr<Source> source = open_source(scratch_.file(""));
  EXPECT_EQ(source->info().frames, 4);
  EXPECT_EQ(numbers(*source), (std::vector<int>{1, 2, 9, 10}));
}

TEST_F(ImageSequenceTest, PatternsChooseFiles) {
  for (int number = 3; number < 6; ++number) {
    write_numbered("a_000" + std::to_string(number) + ".png", number);
    write_numbered("b" + std::to_string(number) + ".png", number + 4);
  }
  const std::unique_ptr<Source> by_number = open_source(scratch_.file("a_%04d.png"));
  EXPECT_EQ(numbers(*by_number), (std::vector<int>{3, 4, 5}));
  EXPECT_EQ(by_number->complaint(), "");
  EXPECT_EQ(numbers(*open_source(scratch_.file("b*.png"))), (std::vector<int>{7, 8, 9}));
  EXPECT_EQ(numbers(*open_source(scratch_.file("?[45].png"))), (std::vector<int>{8, 9}));
  EXPECT_EQ(numbers(*open_source(scratch_.file("b4.png"))), (std::vector<int>{8}));
}

TEST_F(ImageSequenceTest, MissingNumbersTakeTheirTime) {
  for (const int number : {1, 2, 6, 8}) {
    write_numbered("a" + std::to_string(number) + ".png", number);
  }
  for (const char* input : {"a%d.png", "", "a*.png"}) {
    const std::unique_ptr<Source> source = open_source(scratch_.file(input), {.rate = 10.0});
    EXPECT_EQ(source->info().fps, 10.0);
    std::vector<double> times;
    while (const std::optional<Frame> frame = source->next()) {
      times.push_back(10.0 * frame->time);
      EXPECT_EQ(frame->index, std::lround(times.back()));
    }
    EXPECT_EQ(times, (std::vector<double>{0.0, 1.0, 5.0, 7.0}));
    EXPECT_NE(source->complaint().find("4 numbers are missing"), std::string::npos) << source->complaint();
    EXPECT_NE(source->complaint().find("(3 to 5, 7)"), std::string::npos) << source->complaint();
  }
}

TEST_F(ImageSequenceTest, EqualStepsAndTimesMissNoNumbers) {
  const std::vector<std::vector<std::string>> sequences = {
      {"f0", "f5", "f10"},
      {"1699999123456", "1699999123489", "1699999123530"},
      {"a", "b", "c"},
      {"a1", "b1", "c7"}};
  for (const std::vector<std::string>& names : sequences) {
    const std::string folder = "folder-" + names[0];
    std::filesystem::create_directory(scratch_.file(folder));
    for (const std::string& name : names) {
      write_numbered(folder + "/" + name + ".png", 1);
    }
    const std::unique_ptr<Source> source = open_source(scratch_.file(folder));
    for (int i = 0; i < 3; ++i) {
      EXPECT_DOUBLE_EQ(source->next()->time, i / 25.0) << folder;
    }
    EXPECT_EQ(source->complaint(), "");
  }
}

TEST_F(ImageSequenceTest, SkipsUnreadableImagesAndTheirTime) {
  write_numbered("1.png", 1);
  testing::write_bytes(scratch_.file("2.png"), "");
  testing::write_bytes(scratch_.file("3.png"), "not a picture");
  write_numbered("4.png", 4);
  testing::cut_to(scratch_.file("4.png"), 0.2);
  write_numbered("5.png", 5);
  const std::unique_ptr<Source> source = open_source(scratch_.file(""));
  ASSERT_TRUE(source->next());
  const std::optional<Frame> last = source->next();
  ASSERT_TRUE(last);
  EXPECT_EQ(testing::number_of(last->image), 5);
  EXPECT_EQ(last->index, 4);
  EXPECT_DOUBLE_EQ(last->time, 4.0 / 25.0);
  EXPECT_FALSE(source->next());
  EXPECT_NE(source->complaint().find("3 of 5 images"), std::string::npos) << source->complaint();
  EXPECT_NE(source->complaint().find("2.png"), std::string::npos) << source->complaint();
}

TEST_F(ImageSequenceTest, ConvertsImagesToTheFirstSize) {
  const cv::Size size(64, 48);
  write_numbered("1.png", 1);
  write_image("2.png", cv::Mat(size, CV_8UC1, cv::Scalar(50)));
  write_image("3.png", cv::Mat(size, CV_8UC4, cv::Scalar(70, 70, 70, 128)));
  write_image("4.png", cv::Mat(size, CV_16UC1, cv::Scalar(90 * 257)));
  write_image("5.png", cv::Mat(size, CV_16UC3, cv::Scalar::all(110 * 257)));
  write_image("6.tiff", cv::Mat(cv::Size(40, 30), CV_8UC3, cv::Scalar::all(130)));
  write_image("7.jpg", cv::Mat(cv::Size(201, 151), CV_8UC3, cv::Scalar::all(150)));
  const std::unique_ptr<Source> source = open_source(scratch_.file(""));
  EXPECT_EQ(numbers(*source), (std::vector<int>{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_NE(source->complaint().find("resized"), std::string::npos) << source->complaint();
}

TEST_F(ImageSequenceTest, StatesTheCauseOfFailures) {
  const auto refusal = [](const std::string& input) {
    return error_of(ErrorKind::input, [&] { open_source(input); });
  };
  EXPECT_NE(refusal(scratch_.file("")).find("no image in the folder"), std::string::npos);
  EXPECT_NE(refusal(scratch_.file("*.png")).find("no file fits"), std::string::npos);
  EXPECT_NE(refusal(scratch_.file("absent/%d.png")).find("folder cannot be read"), std::string::npos);
  EXPECT_NE(refusal(scratch_.file("absent.png")).find("no such file"), std::string::npos);
  testing::write_bytes(scratch_.file("bad.png"), "not a picture");
  EXPECT_NE(refusal(scratch_.file("bad.png")).find("cannot read"), std::string::npos);
  EXPECT_NE(refusal(scratch_.file("")).find("cannot read"), std::string::npos);
  write_image("dot.png", cv::Mat(1, 1, CV_8UC3));
  EXPECT_NE(refusal(scratch_.file("dot.png")).find("1x1"), std::string::npos);
}

}  // namespace
}  // namespace telemime
