// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>

#include "lab/synth/avatar.h"
#include "telemime/body/face_model.h"

namespace telemime {
namespace {

using Eigen::Vector3f;

// Where the canonical face has its origin in the frame of the drawn head, m.
const Vector3f kFaceOrigin(0.0f, 0.0093f, 0.0500f);

// From the canonical face's axes (y to the chin, z to the back, mm) to those of the drawn head.
Vector3f drawn(const Eigen::Vector3d& canonical) {
  return kFaceOrigin + 1e-3f * Vector3f(1.0f, -1.0f, -1.0f).cwiseProduct(canonical.cast<float>());
}

Eigen::Vector3d canonical(const Vector3f& drawn) {
  return 1e3 * Vector3f(1.0f, -1.0f, -1.0f).cwiseProduct(drawn - kFaceOrigin).cast<double>();
}

// The point of the skin near p, down the slope of the distance.
Vector3f on_skin(Vector3f p) {
  const AvatarHead head;
  for (int i = 0; i < 5; ++i) {
    constexpr float kDelta = 1e-4f;
    const float d = face_distance(head, p);
    Vector3f slope;
    for (int k = 0; k < 3; ++k) {
      slope[k] = (face_distance(head, p + kDelta * Vector3f::Unit(k)) - d) / kDelta;
    }
    p -= d / slope.squaredNorm() * slope;
  }
  return p;
}

TEST(Head, PartsLieWhereAnAverageFaceHasThem) {
  // Corners of the eyes, tip and root of the nose, forehead, corner of the mouth, lips, chin.
  for (const std::size_t i : {33U, 133U, 362U, 263U, 4U, 6U, 10U, 61U, 0U, 17U, 152U}) {
    const Vector3f p = drawn(canonical_face()[i]);
    EXPECT_LT((on_skin(p) - p).norm(), 0.002f) << i;
  }
}

TEST(Head, AxesAreThoseOfAnAverageFace) {
  FacePoints points = canonical_face();
  for (Eigen::Vector3d& p : points) {
    p = canonical(on_skin(drawn(p)));
  }
  const HeadFit fit = fit_head(points);
  EXPECT_LT(fit.rotation.angularDistance(Eigen::Quaterniond::Identity()), 0.01);  // rad
  EXPECT_NEAR(fit.scale, 1.0, 0.02);
}

}  // namespace
}  // namespace telemime
