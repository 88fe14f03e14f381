// SPDX-License-Identifier: Apache-2.0
// One pose and one frame: render the model as the camera sees it, and score two poses against the result.
// Usage: 01_one_frame
#include <cstdio>

#include "telemime/likelihood/backend.h"
#include "telemime/render/renderer.h"

int main() {
  using namespace telemime;
  const Camera camera = camera_from_field_of_view(320, 240, 60.0);
  const Model model = make_model(Shape{});

  Pose truth;
  truth.root = {0.0, 0.45, 1.3};  // metres, camera frame: x right, y down, z forward
  truth[Angle::l_shoulder_abduct] = 0.9;
  truth[Angle::l_elbow_flexion] = -0.7;

  // The rendered classes take the place of a segmented image.
  Rendering seen;
  render(model.mesh, forward_kinematics(model.body, truth), camera, seen);
  FrameFeatures features;
  features.labels = cv::Mat(camera.height, camera.width, CV_8UC1, seen.surface.data()).clone();
  features.distance = cv::Mat::zeros(camera.height, camera.width, CV_32FC1);
  const PreparedFrame frame = prepare(features, camera);

  Pose guess = truth;
  guess[Angle::l_shoulder_abduct] += 0.2;
  const Pose poses[] = {truth, guess};
  Score scores[2];
  make_scalar_backend()->evaluate(frame, model, poses, Reduction::overlap, scores);
  std::printf("F of the true pose %.3f, of a pose 11 degrees off %.3f\n", scores[0].region(),
              scores[1].region());
  return scores[0].region() < scores[1].region() ? 0 : 1;
}
