// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/loop.h"

#include <gtest/gtest.h>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

class Short : public Source {
 public:
  explicit Short(int frames) : frames_(frames) {
    info_.fps = 10.0;
    info_.frames = frames;
  }
  const SourceInfo& info() const override { return info_; }
  std::string complaint() const override { return {}; }
  std::optional<Frame> next() override {
    return index_ < frames_ ? std::optional(Frame{{}, index_, static_cast<double>(index_++) / 10.0})
                            : std::nullopt;
  }

 private:
  SourceInfo info_;
  std::int64_t index_ = 0;
  std::int64_t frames_;
};

TEST(Loop, TimeAndIndexContinue) {
  const auto source = loop([] { return std::make_unique<Short>(3); });
  EXPECT_EQ(source->info().frames, 0) << "nobody knows how many";
  for (int i = 0; i < 10; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_NEAR(frame->time, i / 10.0, 1e-9);
  }
}

TEST(Loop, EndsOnAnEmptyFile) {
  const auto source = loop([] { return std::make_unique<Short>(0); });
  EXPECT_FALSE(source->next());
}

TEST(Loop, EndsWhenTheFileIsGone) {
  int opened = 0;
  const auto source = loop([&opened]() -> std::unique_ptr<Source> {
    if (opened++ > 0) {
      throw Error(ErrorKind::input, "it is gone");
    }
    return std::make_unique<Short>(1);
  });
  EXPECT_TRUE(source->next());
  EXPECT_FALSE(source->next());
  EXPECT_NE(source->complaint().find("gone"), std::string::npos);
}

}  // namespace
}  // namespace telemime
