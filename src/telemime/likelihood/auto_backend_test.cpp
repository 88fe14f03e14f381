// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/all.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

// A clock that advances only while a back end evaluates.
struct Clock {
  double now = 0.0;
  int processor_batches = 0;
  int device_batches = 0;
};

// Takes a fixed time and a time for each pose; D_C says which of the two back ends counted. Fails from batch
// `fails_at` on.
class Worker final : public Backend {
 public:
  Worker(Clock& clock, int& batches, double start, double each, double mark, int fails_at = 1000)
      : clock_(clock), batches_(batches), start_(start), each_(each), mark_(mark), fails_at_(fails_at) {}
  std::string_view name() const override { return "worker"; }
  void count(const PreparedFrame&, const Model&, std::span<const Pose> poses, std::span<const Kinematics>,
             Reduction, std::span<Reductions> counts) override {
    if (++batches_ >= fails_at_) {
      counts.front().contour_points = 7;
      throw Error(ErrorKind::usage, "the device was unplugged");
    }
    clock_.now += start_ + each_ * static_cast<double>(poses.size());
    for (Reductions& r : counts) {
      EXPECT_EQ(r.contour_points, 0) << "counts come in empty";
      r.contour_sum = mark_;
      r.contour_points = 1;
    }
  }
  std::optional<DeviceTimes> device_times() const override { return DeviceTimes{start_, each_, 0.0}; }

 private:
  Clock& clock_;
  int& batches_;
  double start_, each_, mark_;
  int fails_at_;
};

constexpr double kProcessor = 0.25;
constexpr double kDevice = 0.2501;

class Auto : public ::testing::Test {
 protected:
  double evaluate(std::size_t size, int width = 160) {
    frame_.camera.width = width;
    const std::vector<Pose> poses(size);
    std::vector<Score> scores(size);
    backend_->evaluate(frame_, model_, poses, Reduction::all, scores);
    return scores.empty() ? 0.0 : scores.front().contour();
  }

  Clock clock_;
  PreparedFrame frame_;
  Model model_;
  std::unique_ptr<Backend> with_device(double mark, int fails_at = 1000) {
    return make_auto_backend(
        std::make_unique<Worker>(clock_, clock_.processor_batches, 0.0, 6e-6, kProcessor),
        std::make_unique<Worker>(clock_, clock_.device_batches, 1e-3, 1e-7, mark, fails_at),
        [this] { return clock_.now; });
  }
  std::unique_ptr<Backend> backend_ = with_device(kDevice);
};

TEST_F(Auto, GivesLargeBatchesToTheDevice) {
  EXPECT_EQ(evaluate(10000), kDevice) << "the first batch of a kind has the same scores as the others";
  EXPECT_TRUE(backend_->device_times().has_value());
  EXPECT_EQ(evaluate(10000), kDevice);
  EXPECT_TRUE(backend_->device_times().has_value());
  EXPECT_EQ(evaluate(10), kProcessor);
  EXPECT_EQ(evaluate(10), kProcessor);
  EXPECT_FALSE(backend_->device_times().has_value());
}

TEST_F(Auto, MeasuresEachKindOfBatchOnce) {
  evaluate(1000);
  const int measured = clock_.device_batches;
  for (int i = 0; i < 5; ++i) {
    evaluate(1);
    evaluate(600);
  }
  EXPECT_EQ(clock_.device_batches, measured + 2 + 5) << "two runs to measure 1; 600 is of the kind of 1000";
  const int before = clock_.device_batches;
  evaluate(600, 320);
  EXPECT_EQ(clock_.device_batches, before + 2) << "another image size is another kind";
}

TEST_F(Auto, DoesNotUseADeviceThatCountsSomethingElse) {
  for (const double wrong : {9.0, 0.25 + 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    backend_ = with_device(wrong);
    EXPECT_EQ(evaluate(10000), kProcessor);
    EXPECT_EQ(evaluate(10000), kProcessor) << wrong;
  }
}

TEST_F(Auto, GoesOnWithoutADeviceThatFails) {
  for (const int fails_at : {1, 2, 4}) {  // measured in batches 1 and 2
    clock_.device_batches = 0;
    backend_ = with_device(kDevice, fails_at);
    EXPECT_EQ(evaluate(10000), fails_at == 4 ? kDevice : kProcessor);
    EXPECT_EQ(evaluate(10000), fails_at == 4 ? kDevice : kProcessor);
    EXPECT_EQ(evaluate(10000), kProcessor);
    EXPECT_FALSE(backend_->device_times().has_value());
    EXPECT_EQ(evaluate(10000), kProcessor);
    EXPECT_EQ(clock_.device_batches, fails_at) << "it is not asked again";
  }
}

TEST(Backends, AreFoundByName) {
  const std::string unknown = error_of(ErrorKind::usage, [] { make_backend("abacus"); });
  for (const BackendKind& kind : kBackends) {
    if (kind.missing().empty()) {
      EXPECT_NE(make_backend(kind.name), nullptr) << kind.name;
    }
    EXPECT_NE(unknown.find(kind.name), std::string::npos) << unknown;
  }
}

}  // namespace
}  // namespace telemime
