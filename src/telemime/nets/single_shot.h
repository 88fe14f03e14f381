// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "telemime/nets/network.h"
#include "telemime/nets/picture_region.h"

namespace telemime {

/// A box and points that a single-shot detector predicts, in pixels of the picture.
struct Detection {
  double score = 0.0;                             ///< (0.5, 1]
  Eigen::Vector4d box = Eigen::Vector4d::Zero();  ///< left, top, right, bottom
  std::vector<Eigen::Vector2d> keypoints;
};

/// A detector whose boxes are predicted relative to points on grids, several for each point. Its outputs are
/// the boxes (centre, size, keypoints in pixels of the input) and the logits of their scores.
struct SingleShotFormat {
  struct Grid {
    int cells = 0;    ///< in a row and in a column
    int anchors = 0;  ///< in each cell
  };
  int input = 0;  ///< pixels of a side
  std::vector<Grid> grids;
  std::size_t keypoints = 0;
};

/// What is found in a square region of a BGR picture, the best first. Overlapping candidates are averaged by
/// score (weighted non-maximum suppression).
std::vector<Detection> detect(const cv::Mat& picture, const PictureRegion& region, Network& network,
                              const SingleShotFormat& format);

}  // namespace telemime
