// SPDX-License-Identifier: Apache-2.0
// Measures the time of one F and one D_C evaluation on this machine.
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "telemime/core/camera.h"
#include "telemime/image/edges.h"
#include "telemime/render/renderer.h"
#include "telemime/search/budget.h"

namespace telemime {

PreparedFrame frame_of_model(const Model& model, const Pose& pose, const Camera& camera) {
  Rendering rendering;
  render(model.mesh, forward_kinematics(model.body, pose), camera, rendering);
  std::vector<Eigen::Vector2f> contour;
  occluding_contour(model.mesh, rendering, contour);

  FrameFeatures seen;
  seen.labels = cv::Mat(camera.height, camera.width, CV_8UC1, rendering.surface.data()).clone();
  seen.edges = cv::Mat::zeros(camera.height, camera.width, CV_8UC1);
  for (const Eigen::Vector2f& p : contour) {
    seen.edges.at<std::uint8_t>(static_cast<int>(std::lround(p.y())), static_cast<int>(std::lround(p.x()))) =
        255;
  }
  constexpr double kCapAt160 = 10.0;  // as in feature extraction
  seen.distance = distance_map(seen.edges, kCapAt160 * reference_width(camera.width, camera.height) / 160.0);
  return prepare(seen, camera);
}

std::vector<Pose> typical_poses(std::size_t count, Random& random) {
  Pose middle;
  middle.root = {0.0, 0.25, 1.2};
  middle[Angle::l_shoulder_flexion] = middle[Angle::r_shoulder_flexion] = -0.5;
  middle[Angle::l_shoulder_abduct] = 0.5;
  middle[Angle::r_shoulder_abduct] = -0.5;
  middle[Angle::l_elbow_flexion] = middle[Angle::r_elbow_flexion] = -1.4;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    Pose pose = middle;
    for (double& angle : pose.angles) {
      angle += random.normal(0.0, 0.05);
    }
    poses.push_back(pose);
  }
  return poses;
}

EvaluationCost measure_cost(Backend& backend, const Model& model, const Camera& camera, int repeats,
                            Random& random, const std::function<double()>& seconds) {
  const std::vector<Pose> poses = typical_poses(50, random);
  const PreparedFrame frame = frame_of_model(model, poses.front(), camera);
  std::vector<Score> scores(poses.size());
  const auto median_ms = [&](Reduction terms) {
    std::vector<double> times;
    backend.evaluate(frame, model, poses, terms, scores);  // warm-up
    for (int i = 0; i < std::max(1, repeats); ++i) {
      const double start = seconds();
      for (std::size_t k = 0; k < poses.size(); ++k) {  // one by one, as the search asks for them
        backend.evaluate(frame, model, std::span(poses).subspan(k, 1), terms,
                         std::span(scores).subspan(k, 1));
      }
      times.push_back(1e3 * (seconds() - start) / static_cast<double>(poses.size()));
    }
    std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2),
                     times.end());
    return times[times.size() / 2];
  };
  EvaluationCost cost;
  cost.width = camera.width;
  cost.height = camera.height;
  cost.region_ms = median_ms(Reduction::overlap);
  cost.edge_ms = median_ms(Reduction::contour);
  return cost;
}

}  // namespace telemime
