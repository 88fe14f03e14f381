// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/head_shape.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "telemime/image/connected_components.h"

namespace telemime {
namespace {

// Where a head by its outline ends and the shoulders begin, in widths of the head so far.
constexpr double kLeastRows = 0.7;    // above the shoulders
constexpr double kMostRows = 2.4;     // without shoulders: not a head
constexpr double kShoulders = 1.5;    // width of the first row of the shoulders
constexpr double kHeadsAbove = 1.25;  // heights of the head from the crown to the shoulders
// Height of a head over its width: usual, least and most.
constexpr double kUsualHeight = 1.4, kLeastHeight = 1.2, kMostHeight = 1.7;
// Where adapted() measures the outline of the head, in its radii.
constexpr double kReachUp = 1.5, kReachAside = 1.6;
constexpr double kCrownColumns = 0.4;                   // to both sides of the centre
constexpr double kSideAbove = 0.45, kSideBelow = 0.15;  // rows above and below the centre
// Quantiles of the measured distances: hair and ears stick out, shadows cut in.
constexpr double kTopQuantile = 0.7, kLeftQuantile = 0.4, kRightQuantile = 0.6;
// Width of a head, least and most, over the square root of the person's area.
constexpr double kThinnestHead = 0.14, kWidestHead = 0.5;
// faces_camera(): a row through the shoulders (head radii below its centre), the least half width there (head
// radii), and the largest ratio of the two halves.
constexpr double kShoulderRow = 2.3, kLeastShoulder = 1.5, kMostUneven = 1.7;

/// Range of a value of HeadShape.
struct Range {
  double least;
  double most;
};
constexpr Range kShift{-0.25, 0.25};
constexpr Range kHalfWidth{0.34, 0.62};
constexpr Range kCrown{0.5, 1.0};

double clamped(const Range& range, double value) {
  return std::clamp(value, range.least, range.most);
}

/// The quantile of at least three values; empty for fewer.
std::optional<double> quantile(std::vector<double> values, double share) {
  if (values.size() < 3) {
    return std::nullopt;
  }
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Number of steps from (row, column) along (dr, dc) inside the silhouette, at most `most`.
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

/// The silhouette pixels [left, right] of a row.
struct Run {
  int left = 0;
  int right = -1;
  int width() const { return right - left + 1; }
};

/// The run in `row` that contains `column`, or the widest run if none does.
Run run_at(const cv::Mat& person, int row, int column) {
  Run best;
  const auto* p = person.ptr<unsigned char>(row);
  for (int c = 0; c < person.cols; ++c) {
    if (p[c] == 0) {
      continue;
    }
    Run run{c, c};
    while (run.right + 1 < person.cols && p[run.right + 1] != 0) {
      ++run.right;
    }
    if (run.left <= column && column <= run.right) {
      return run;
    }
    best = run.width() > best.width() ? run : best;
    c = run.right;
  }
  return best;
}

/// Follows the person down from the top until the rows widen to the shoulders. The width of the head must be
/// between `thinnest` and `widest`.
std::optional<HeadRegion> head_of_person(const cv::Mat& person, double thinnest, double widest) {
  int top = 0;
  while (top < person.rows && run_at(person, top, -1).width() <= 0) {
    ++top;
  }
  const bool cut_by_picture = top <= 1;
  // The runs so far. Shoulders slope, so a row is compared with those well above it.
  std::vector<Run> runs;
  const auto widest_of_upper = [&runs] {
    const auto upper =
        runs.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, runs.size() * 3 / 5));
    return *std::max_element(runs.begin(), upper,
                             [](const Run& a, const Run& b) { return a.width() < b.width(); });
  };
  Run head_run;
  int column = -1;
  bool shoulders = false;
  for (int r = top; r < person.rows; ++r) {
    const Run run = run_at(person, r, column);
    if (run.width() <= 0) {
      return std::nullopt;
    }
    if (runs.size() >= 3) {
      head_run = widest_of_upper();
      const double so_far = head_run.width();
      const auto rows = static_cast<double>(runs.size());
      if (so_far >= thinnest && (rows >= kLeastRows * so_far || cut_by_picture) &&
          run.width() > kShoulders * so_far) {
        shoulders = true;
        break;
      }
      if (rows > kMostRows * std::max(so_far, thinnest)) {
        break;
      }
    }
    runs.push_back(run);
    column = (run.left + run.right) / 2;
  }
  const double width = head_run.width();
  const auto rows = static_cast<double>(runs.size());
  if (!shoulders || width > widest) {
    return std::nullopt;
  }
  const double height = cut_by_picture
                            ? kUsualHeight * width
                            : std::clamp(rows / kHeadsAbove, kLeastHeight * width, kMostHeight * width);
  HeadRegion head;
  head.radii = {0.5 * width, 0.5 * height};
  head.centre = {0.5 * (head_run.left + head_run.right),
                 cut_by_picture ? top + rows / kHeadsAbove - 0.5 * height : top - 0.5 + 0.5 * height};
  return head;
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

HeadShape rebased(const HeadShape& shape, const TrackedFace& from, const TrackedFace& to) {
  const double larger = from.side / to.side;
  HeadShape out = shape;
  out.shift = clamped(kShift, shape.shift * larger + (from.centre.x - to.centre.x) / to.side);
  out.half_width = clamped(kHalfWidth, shape.half_width * larger);
  out.crown = clamped(kCrown, shape.crown * larger - (from.centre.y - to.centre.y) / to.side);
  return out;
}

HeadShape adapted(const HeadShape& shape, const HeadRegion& head, const cv::Mat& silhouette, double rate) {
  // Side of the face square in working pixels.
  const double side_x = head.radii.x() / shape.half_width;
  const double side_y = 2 * head.radii.y() / (shape.crown + shape.chin);
  const auto inside = [&](int r, int c) {
    return r >= 0 && r < silhouette.rows && c >= 0 && c < silhouette.cols &&
           silhouette.at<unsigned char>(r, c) != 0;
  };
  const int middle_row = static_cast<int>(std::lround(head.centre.y()));
  const int middle_column = static_cast<int>(std::lround(head.centre.x()));

  // Distances from the centre to the crown, in columns near the middle.
  std::vector<double> tops;
  const int reach_up = static_cast<int>(kReachUp * head.radii.y());
  const int across = std::max(1, static_cast<int>(kCrownColumns * head.radii.x()));
  for (int c = middle_column - across; c <= middle_column + across; ++c) {
    if (!inside(middle_row, c)) {
      continue;
    }
    const int run = run_length(silhouette, middle_row, c, -1, 0, reach_up);
    if (run < reach_up) {
      tops.push_back(run + 0.5 - (head.centre.y() - middle_row));
    }
  }
  // Left and right outline, in rows around the centre.
  std::vector<double> lefts;
  std::vector<double> rights;
  const int reach = static_cast<int>(kReachAside * head.radii.x());
  const int first = static_cast<int>(std::lround(head.centre.y() - kSideAbove * head.radii.y()));
  const int last = static_cast<int>(std::lround(head.centre.y() + kSideBelow * head.radii.y()));
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

  // Move the shape towards the measured outline. The centre of the square is in working pixels.
  HeadShape out = shape;
  const double face_x = head.centre.x() - shape.shift * side_x;
  const double face_y = head.centre.y() - 0.5 * (shape.chin - shape.crown) * side_y;
  const auto move = [rate](double& value, double measured, const Range& range) {
    value += rate * (clamped(range, measured) - value);
  };
  if (const auto top = quantile(tops, kTopQuantile)) {
    move(out.crown, (face_y - (head.centre.y() - *top)) / side_y, kCrown);
  }
  const auto left = quantile(lefts, kLeftQuantile);
  const auto right = quantile(rights, kRightQuantile);
  if (left && right) {
    move(out.shift, (0.5 * (*left + *right) - face_x) / side_x, kShift);
    move(out.half_width, 0.5 * (*right - *left) / side_x, kHalfWidth);
  }
  return out;
}

std::optional<HeadRegion> head_from_silhouette(const cv::Mat& silhouette) {
  // The largest component must be large enough for a person.
  const ConnectedComponents pieces(silhouette, Connectivity::eight);
  const auto largest =
      std::max_element(pieces.all().begin(), pieces.all().end(),
                       [](const Component& a, const Component& b) { return a.area < b.area; });
  constexpr double kSmallestPerson = 0.01;
  if (largest == pieces.all().end() ||
      largest->area < kSmallestPerson * static_cast<double>(silhouette.total())) {
    return std::nullopt;
  }
  // Remove spikes of the outline that are thinner than a head.
  const double scale = std::sqrt(static_cast<double>(largest->area));
  const double thinnest = kThinnestHead * scale;
  const int brush = std::max(3, static_cast<int>(0.5 * thinnest) | 1);
  cv::Mat person = cv::Mat::zeros(silhouette.size(), CV_8UC1);
  pieces.paint(*largest, 255, person);
  cv::morphologyEx(person, person, cv::MORPH_OPEN,
                   cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(brush, brush)));
  return head_of_person(person, thinnest, kWidestHead * scale);
}

bool faces_camera(const HeadRegion& head, const cv::Mat& silhouette) {
  const int row = static_cast<int>(head.centre.y() + kShoulderRow * head.radii.y());
  const int column = static_cast<int>(head.centre.x());
  if (row < 0 || row >= silhouette.rows || column < 0 || column >= silhouette.cols) {
    return false;
  }
  const double left = run_length(silhouette, row, column, 0, -1, silhouette.cols);
  const double right = run_length(silhouette, row, column, 0, 1, silhouette.cols);
  return std::min(left, right) > kLeastShoulder * head.radii.x() &&
         std::max(left, right) < kMostUneven * std::min(left, right);
}

cv::Rect2d face_square(const HeadRegion& head, const HeadShape& shape, double scale_x, double scale_y) {
  const double side = 2 * head.radii.y() / scale_y / (shape.crown + shape.chin);
  const double x = (head.centre.x() + 0.5) / scale_x - 0.5 - shape.shift * side;
  const double y = (head.centre.y() + 0.5) / scale_y - 0.5 - 0.5 * (shape.chin - shape.crown) * side;
  return {x - 0.5 * (side - 1), y - 0.5 * (side - 1), side, side};
}

}  // namespace telemime
