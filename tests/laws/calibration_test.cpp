// SPDX-License-Identifier: Apache-2.0
// Calibration on frames rendered from a model with other proportions.
#include "telemime/search/calibration.h"

#include <gtest/gtest.h>

#include "support/rendered_person.h"

namespace telemime {
namespace {

using support::observe;
using testing_poses::kDegree;

// A person whose arms differ from the average by this factor. One view of a bent elbow hardly shows how an
// arm's length is divided between upper arm and forearm, so both get the same factor.
Shape person(double arms) {
  Shape shape;
  shape.stature = 1.76;
  for (const Segment s :
       {Segment::l_upper_arm, Segment::r_upper_arm, Segment::l_forearm, Segment::r_forearm}) {
    shape[s].length = arms;
  }
  shape.sleeve = 0.6;
  return shape;
}

Calibration calibrated(const Shape& shape, const Pose& pose, std::uint64_t seed = 1,
                       CalibrationConfig config = {}, bool face = true) {
  const Camera camera = camera_from_field_of_view(160, 120, 60.0);
  FrameFeatures seen = observe(make_model(shape), pose, camera);
  seen.head->detected = face;
  config.stature = shape.stature;
  const auto backend = make_scalar_backend();
  Random random(seed);
  return calibrate(*backend, prepare(seen, camera), *seen.head, anatomical_limits(), config,
                   RegistrationConfig{}, random);
}

Pose arms_apart() {
  Pose pose = support::seated({0, 0, 45 * kDegree, -30 * kDegree}, {0, 0, 50 * kDegree, -30 * kDegree});
  pose[Angle::l_shoulder_twisting] = 65 * kDegree;  // forearms also nearly in the image plane
  pose[Angle::r_shoulder_twisting] = -65 * kDegree;
  return pose;
}

TEST(CalibrationLaw, FindsTheLengthsOfFreeArms) {
  for (const double arms : {0.92, 1.08}) {
    const Body truth = make_body(person(arms));
    const Calibration found = calibrated(person(arms), arms_apart());
    EXPECT_EQ(found.refusal, "");
    const Body body = make_body(found.shape);
    for (const std::size_t side : {0U, 1U}) {
      EXPECT_NEAR(body.upper_arm_length[side] / truth.upper_arm_length[side], 1.0, 0.06) << arms;
      EXPECT_NEAR(body.forearm_length[side] / truth.forearm_length[side], 1.0, 0.06) << arms;
    }
    EXPECT_LT(found.score.region(), 0.06);
    EXPECT_TRUE(anatomical_limits().contains(found.pose));
    const JointPositions a = forward_kinematics(truth, arms_apart()).joints;
    const JointPositions b = forward_kinematics(body, found.pose).joints;
    for (const Joint j : {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist, Joint::r_wrist}) {
      EXPECT_LT((a[j].head<2>() / a[j].z() - b[j].head<2>() / b[j].z()).norm() * a[j].z(), 0.03)
          << kJointNames[static_cast<std::size_t>(j)] << " " << arms;
    }
  }
}

TEST(CalibrationLaw, TellsLongArmsFromShortOnes) {
  const auto length = [](double arms) {
    const Body body = make_body(calibrated(person(arms), arms_apart()).shape);
    return body.upper_arm_length[0] + body.forearm_length[0];
  };
  EXPECT_GT(length(1.08) / length(0.92), 1.08);
}

TEST(CalibrationLaw, SameSeedSameShape) {
  const Calibration a = calibrated(person(1.08), arms_apart(), 5);
  const Calibration b = calibrated(person(1.08), arms_apart(), 5);
  EXPECT_EQ(a.pose.vector(), b.pose.vector());
  EXPECT_EQ(a.shape[Segment::l_forearm].length, b.shape[Segment::l_forearm].length);
  EXPECT_EQ(a.evaluations, b.evaluations);
}

TEST(CalibrationLaw, RefusesAHandBeforeTheBody) {
  const Pose crossed = support::seated({-25 * kDegree, -40 * kDegree, 5 * kDegree, -100 * kDegree},
                                       {0, 0, 40 * kDegree, -20 * kDegree});
  const Calibration found = calibrated(Shape{}, crossed);
  EXPECT_NE(found.refusal.find("left"), std::string::npos) << found.refusal;
}

TEST(CalibrationLaw, RefusesAnArmThatLeavesThePicture) {
  Pose out = arms_apart();
  out.root.z() = 0.9;
  out[Angle::l_shoulder_abduct] = 85 * kDegree;
  EXPECT_NE(calibrated(Shape{}, out).refusal, "");
}

TEST(CalibrationLaw, WithoutAFaceTheBodyMustFitBetter) {
  CalibrationConfig config;
  config.worst_region = 1.1 * calibrated(person(1.0), arms_apart()).score.region();
  EXPECT_EQ(calibrated(person(1.0), arms_apart(), 1, config, true).refusal, "");
  const std::string refusal = calibrated(person(1.0), arms_apart(), 1, config, false).refusal;
  EXPECT_NE(refusal.find("does not fit"), std::string::npos) << refusal;
}

TEST(CalibrationLaw, RefusesWhatIsNoPerson) {
  const Camera camera = camera_from_field_of_view(160, 120, 60.0);
  FrameFeatures seen;
  seen.labels = cv::Mat::zeros(120, 160, CV_8UC1);
  seen.labels(cv::Rect(70, 20, 20, 25)).setTo(1);  // a head and nothing else
  seen.distance = cv::Mat(120, 160, CV_32FC1, cv::Scalar(20));
  const HeadRegion head = {{80, 32}, {9, 12}, true};
  const auto backend = make_scalar_backend();
  Random random(1);
  const Calibration found = calibrate(*backend, prepare(seen, camera), head, anatomical_limits(),
                                      CalibrationConfig{}, RegistrationConfig{}, random);
  EXPECT_NE(found.refusal, "");
  EXPECT_TRUE(found.pose.vector().allFinite());
}

}  // namespace
}  // namespace telemime
