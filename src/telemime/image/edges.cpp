// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/edges.h"

#include <cmath>
#include <vector>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

/// Whether the magnitude at the pixel exceeds that at both points one pixel away along the gradient.
bool is_ridge(const cv::Mat& squared, int r, int c, float gx, float gy) {
  const float ax = std::fabs(gx);
  const float ay = std::fabs(gy);
  const int sx = gx >= 0 ? 1 : -1;
  const int sy = gy >= 0 ? 1 : -1;
  const bool mostly_x = ax >= ay;
  const float slant = mostly_x ? ay / ax : ax / ay;
  const auto at = [&](int dr, int dc) { return std::sqrt(squared.at<float>(r + dr, c + dc)); };
  const float straight_ahead = mostly_x ? at(0, sx) : at(sy, 0);
  const float straight_back = mostly_x ? at(0, -sx) : at(-sy, 0);
  const float ahead = straight_ahead + slant * (at(sy, sx) - straight_ahead);
  const float back = straight_back + slant * (at(-sy, -sx) - straight_back);
  const float here = at(0, 0);
  // Of two equal pixels exactly one is a maximum, hence > on one side only.
  return here > back && here >= ahead;
}

}  // namespace

cv::Mat find_edges(const Gradient& gradient, const cv::Mat& mask, double low, double high) {
  if (gradient.dx.size() != mask.size() || gradient.dy.size() != mask.size()) {
    throw Error(ErrorKind::usage, "edges: the gradient and the mask differ in size");
  }
  if (!(low >= 0 && low <= high)) {
    throw Error(ErrorKind::usage, "edges: thresholds must satisfy 0 <= low <= high");
  }
  const int rows = mask.rows;
  const int columns = mask.cols;
  const cv::Mat squared = gradient.dx.mul(gradient.dx) + gradient.dy.mul(gradient.dy);
  const auto low2 = static_cast<float>(low * low);
  const auto high2 = static_cast<float>(high * high);

  // Non-maximum suppression.
  cv::Mat edges = cv::Mat::zeros(rows, columns, CV_8UC1);
  constexpr unsigned char kWeak = 1;
  std::vector<cv::Point> open;
  for (int r = 1; r + 1 < rows; ++r) {
    const auto* m = mask.ptr<unsigned char>(r);
    const auto* s = squared.ptr<float>(r);
    auto* e = edges.ptr<unsigned char>(r);
    for (int c = 1; c + 1 < columns; ++c) {
      if (m[c] == 0 || s[c] < low2 || s[c] <= 0) {
        continue;
      }
      if (!is_ridge(squared, r, c, gradient.dx.at<float>(r, c), gradient.dy.at<float>(r, c))) {
        continue;
      }
      e[c] = kWeak;
      if (s[c] >= high2) {
        e[c] = 255;
        open.emplace_back(c, r);
      }
    }
  }
  // Hysteresis: follow weak edges that are connected to strong ones.
  while (!open.empty()) {
    const cv::Point p = open.back();
    open.pop_back();
    for (int r = p.y - 1; r <= p.y + 1; ++r) {
      for (int c = p.x - 1; c <= p.x + 1; ++c) {
        auto& e = edges.at<unsigned char>(r, c);
        if (e == kWeak) {
          e = 255;
          open.emplace_back(c, r);
        }
      }
    }
  }
  edges.setTo(0, edges == kWeak);
  return edges;
}

}  // namespace telemime
