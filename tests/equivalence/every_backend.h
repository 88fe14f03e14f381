// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "support/rendered_person.h"
#include "telemime/likelihood/all.h"

namespace telemime {

inline void PrintTo(const BackendKind& kind, std::ostream* out) {
  *out << kind.name;
}

}  // namespace telemime

/// Compares every back end of kBackends with `scalar`.
namespace telemime::equivalence {

using testing_poses::random_pose;

/// Three people: average, with other proportions, and a child with long sleeves.
inline std::vector<Model> people() {
  Shape child;
  child.stature = 1.15;
  child[Segment::head] = {1.2, 1.25, 1.25};
  child.sleeve = 1.5;
  return {make_model(Shape{}), make_model(testing_poses::other_shape()), make_model(child)};
}

inline Camera camera_of(int width, int height) {
  return camera_from_field_of_view(width, height, 60.0);
}

inline PreparedFrame frame_of(const Model& model, const Pose& pose, const Camera& camera) {
  return prepare(support::observe(model, pose, camera), camera);
}

inline std::vector<Score> scores_of(Backend& backend, const PreparedFrame& frame, const Model& model,
                                    std::span<const Pose> poses) {
  std::vector<Score> scores(poses.size());
  backend.evaluate(frame, model, poses, Reduction::all, scores);
  return scores;
}

/// Differences of scores from those of `scalar`.
class Deviations {
 public:
  void add(const Score& score, const Score& definition) {
    const double region = std::abs(score.region() - definition.region());
    const double contour = std::abs(score.contour() - definition.contour());
    ++poses_;
    region_ += region;
    contour_ += contour;
    most_region_ = std::max(most_region_, region);
    most_contour_ = std::max(most_contour_, contour);
    const Reductions& a = score.reductions;
    const Reductions& b = definition.reductions;
    EXPECT_EQ(a.observed, b.observed);
    for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
      most_pixels_ =
          std::max({most_pixels_, std::abs(a.model[c] - b.model[c]), std::abs(a.both[c] - b.both[c])});
    }
    most_points_ = std::max(most_points_, std::abs(a.contour_points - b.contour_points));
  }

  double mean_region() const { return region_ / std::max(1, poses_); }
  double mean_contour() const { return contour_ / std::max(1, poses_); }
  double most_region() const { return most_region_; }    ///< of one pose
  double most_contour() const { return most_contour_; }  ///< px, of one pose
  int most_pixels() const { return most_pixels_; }       ///< of one class of one pose
  int most_points() const { return most_points_; }       ///< of the contour of one pose

 private:
  int poses_ = 0;
  double region_ = 0.0;
  double contour_ = 0.0;
  double most_region_ = 0.0;
  double most_contour_ = 0.0;
  int most_pixels_ = 0;
  int most_points_ = 0;
};

/// Largest accepted deviations, two to three times the measured ones: back ends round differently, so that a
/// pixel or contour point near a border may fall on either side.
struct Tolerance {
  double mean_region;
  double mean_contour;  ///< px
  double most_region;
  double most_contour;  ///< px
  int pixels;           ///< of one class of one pose
  int points;
};

/// A back end that cannot run here is skipped with the reason. Each interval of the clock is shorter than the
/// one before, so that `auto` finds a GPU faster and uses it for all batches.
class EveryBackend : public ::testing::TestWithParam<BackendKind> {
 protected:
  void SetUp() override {
    const std::string missing = GetParam().missing();
    if (!missing.empty()) {
      GTEST_SKIP() << GetParam().name << " was not run: " << missing;
    }
    backend_ = make_backend(GetParam().name,
                            {.seconds = [now = 0.0, calls = 0]() mutable { return now += 1.0 / ++calls; }});
  }

  /// Adds to `deviations` and checks that every score is possible.
  void compare(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
               Deviations& deviations) {
    const std::vector<Score> scores = scores_of(*backend_, frame, model, poses);
    const std::vector<Score> definition = scores_of(*scalar_, frame, model, poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      expect_possible(scores[i], frame);
      deviations.add(scores[i], definition[i]);
    }
  }

  Deviations compared(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses) {
    Deviations deviations;
    compare(frame, model, poses, deviations);
    return deviations;
  }

  static void expect_possible(const Score& score, const PreparedFrame& frame) {
    EXPECT_TRUE(score.region() >= 0.0 && score.region() <= 1.0) << score.region();
    // Back ends add in single precision.
    EXPECT_TRUE(score.contour() >= 0.0 && score.contour() <= frame.distance_cap * (1.0 + 1e-5))
        << score.contour();
    EXPECT_GE(score.reductions.contour_points, 0);
    for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
      EXPECT_GE(score.reductions.both[c], 0);
      EXPECT_LE(score.reductions.both[c], score.reductions.model[c]);
      EXPECT_LE(score.reductions.both[c], score.reductions.observed[c]);
    }
  }

  void expect_within(const std::string& what, const Deviations& d, const Tolerance& tolerance) {
    SCOPED_TRACE(what);
    const auto keep = [&](const std::string& name, double value) {
      RecordProperty(what + "_" + name, std::to_string(value));
    };
    keep("mean_region", d.mean_region());
    keep("mean_contour_px", d.mean_contour());
    keep("most_region", d.most_region());
    keep("most_contour_px", d.most_contour());
    keep("most_pixels", d.most_pixels());
    keep("most_points", d.most_points());
    EXPECT_LE(d.mean_region(), tolerance.mean_region);
    EXPECT_LE(d.mean_contour(), tolerance.mean_contour);
    EXPECT_LE(d.most_region(), tolerance.most_region);
    EXPECT_LE(d.most_contour(), tolerance.most_contour);
    EXPECT_LE(d.most_pixels(), tolerance.pixels);
    EXPECT_LE(d.most_points(), tolerance.points);
  }

  std::unique_ptr<Backend> backend_;
  std::unique_ptr<Backend> scalar_ = make_scalar_backend();
};

inline std::string name_of(const ::testing::TestParamInfo<BackendKind>& info) {
  return std::string(info.param.name);
}

}  // namespace telemime::equivalence
