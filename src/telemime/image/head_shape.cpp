// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/head_shape.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace telemime {
namespace {

std::optional<double> quantile(std::vector<double> values, double share) {
  if (values.size() < 3) {
    return std::nullopt;
  }
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Steps from (row, column) along (dr, dc) while inside the silhouette; at most `most`.
int run_length(const cv::Mat& silhouette, int row, int column, int dr, int dc, int most) {
  int steps = 0;
  while (steps < most) {
    const int r = row + dr * (steps + 1);
    const int c = column + dc * (steps + 1);
    if (r < 0 || r >= silhouette.rows || c < 0 || c >= silhouette.cols ||
        silhouette.at<unsigned char>(r, c) == 0) {
      break;
    }
    ++steps;
  }
  return steps;
}

}  // namespace

HeadRegion head_region(const TrackedFace& face, const HeadShape& shape, double scale_x, double scale_y) {
  const double crown = face.centre.y - shape.crown * face.side;
  const double chin = face.centre.y + shape.chin * face.side;
  HeadRegion head;
  head.centre = {(face.centre.x + shape.shift * face.side + 0.5) * scale_x - 0.5,
                 (0.5 * (crown + chin) + 0.5) * scale_y - 0.5};
  head.radii = {shape.half_width * face.side * scale_x, 0.5 * (chin - crown) * scale_y};
  head.detected = face.detected;
  return head;
}

HeadShape adapted(const HeadShape& shape, const HeadRegion& head, const cv::Mat& silhouette, double rate) {
  // Pixels of a side, from the region that the shape made.
  const double side_x = head.radii.x() / shape.half_width;
  const double side_y = 2 * head.radii.y() / (shape.crown + shape.chin);
  const auto inside = [&](int r, int c) {
    return r >= 0 && r < silhouette.rows && c >= 0 && c < silhouette.cols &&
           silhouette.at<unsigned char>(r, c) != 0;
  };
  const int middle_row = static_cast<int>(std::lround(head.centre.y()));
  const int middle_column = static_cast<int>(std::lround(head.centre.x()));

  std::vector<double> tops;
  const int reach_up = static_cast<int>(1.5 * head.radii.y());
  const int across = std::max(1, static_cast<int>(0.4 * head.radii.x()));
  for (int c = middle_column - across; c <= middle_column + across; ++c) {
    if (!inside(middle_row, c)) {
      continue;
    }
    const int run = run_length(silhouette, middle_row, c, -1, 0, reach_up);
    if (run < reach_up) {
      tops.push_back(run + 0.5 - (head.centre.y() - middle_row));
    }
  }
  std::vector<double> lefts;
  std::vector<double> rights;
  const int reach = static_cast<int>(1.6 * head.radii.x());
  const int first = static_cast<int>(std::lround(head.centre.y() - 0.45 * head.radii.y()));
  const int last = static_cast<int>(std::lround(head.centre.y() + 0.15 * head.radii.y()));
  for (int r = first; r <= last; ++r) {
    if (!inside(r, middle_column)) {
      continue;
    }
    const int left = run_length(silhouette, r, middle_column, 0, -1, reach);
    const int right = run_length(silhouette, r, middle_column, 0, 1, reach);
    if (left < reach && right < reach) {
      lefts.push_back(middle_column - left - 0.5);
      rights.push_back(middle_column + right + 0.5);
    }
  }

  HeadShape out = shape;
  // The square's centre, in working pixels.
  const double face_x = head.centre.x() - shape.shift * side_x;
  const double face_y = head.centre.y() - 0.5 * (shape.chin - shape.crown) * side_y;
  const auto move = [rate](double& value, double measured, double least, double most) {
    value += rate * (std::clamp(measured, least, most) - value);
  };
  if (const auto top = quantile(tops, 0.7)) {
    move(out.crown, (face_y - (head.centre.y() - *top)) / side_y, 0.5, 1.0);
  }
  const auto left = quantile(lefts, 0.4);
  const auto right = quantile(rights, 0.6);
  if (left && right) {
    move(out.shift, (0.5 * (*left + *right) - face_x) / side_x, -0.25, 0.25);
    move(out.half_width, 0.5 * (*right - *left) / side_x, 0.34, 0.62);
  }
  return out;
}

}  // namespace telemime
