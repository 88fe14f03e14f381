// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/camera_motion.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <set>
#include <utility>
#include <vector>

#include "telemime/core/camera.h"
#include "telemime/image/log_colour.h"

namespace telemime {
namespace {

// Corners are taken from the cells of a grid, so that no textured corner of the image has all of them.
constexpr int kGridColumns = 10;
constexpr int kGridRows = 8;
constexpr int kInCell = 2;
constexpr std::size_t kFewestCorners = 10;
constexpr std::size_t kFewestCells = 6;
constexpr int kWindow = 11;  // pixels, of the optical flow

// Logarithms, less their local mean, over their local contrast: independent of gain and gamma, 8 bits.
// Contrast below the noise of a camera is not amplified.
cv::Mat normalised(const cv::Mat& grey) {
  constexpr double kNoise = 5.0;  // grey levels
  const double sigma = std::max(2.0, reference_width(grey.cols, grey.rows) / 40.0);
  cv::Mat log;
  grey.convertTo(log, CV_32FC1);
  cv::GaussianBlur(log, log, {0, 0}, 0.8);
  log += cv::Scalar(kLogColourOffset);
  cv::log(log, log);
  cv::Mat mean;
  cv::GaussianBlur(log, mean, {0, 0}, sigma);
  cv::Mat noise;
  cv::exp(-mean, noise);
  noise *= kNoise;
  cv::Mat detail = log - mean;
  cv::Mat contrast;
  cv::GaussianBlur(detail.mul(detail), contrast, {0, 0}, sigma);
  contrast += noise.mul(noise);
  cv::sqrt(contrast, contrast);
  cv::Mat out;
  cv::divide(detail, contrast, detail);
  detail.convertTo(out, CV_8UC1, 42.0, 128.0);
  return out;
}

// Where corners can be followed: in the scene, and neither image is black or white there.
cv::Mat usable(const cv::Mat& before, const cv::Mat& after, const cv::Mat& scene) {
  constexpr double kBlack = 4;
  constexpr double kWhite = 250;
  cv::Mat out = (scene != 0) & (before > kBlack) & (before < kWhite) & (after > kBlack) & (after < kWhite);
  // An occlusion at the edge of the window would pull the corner along.
  cv::erode(out, out, cv::getStructuringElement(cv::MORPH_RECT, {kWindow / 2 * 2 + 1, kWindow / 2 * 2 + 1}),
            {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  return out;
}

// The clearest corners of each cell.
std::vector<cv::Point2f> corners_of(const cv::Mat& image, const cv::Mat& where) {
  constexpr float kLeast = 4e-4F;  // smaller eigenvalue of the structure tensor: below it is noise
  cv::Mat strength;
  cv::cornerMinEigenVal(image, strength, 5);
  cv::Mat largest;
  cv::dilate(strength, largest, cv::getStructuringElement(cv::MORPH_RECT, {7, 7}));
  struct Candidate {
    float strength;
    cv::Point at;
  };
  std::vector<cv::Point2f> corners;
  for (int cell = 0; cell < kGridColumns * kGridRows; ++cell) {
    const int row = cell / kGridColumns;
    const int column = cell % kGridColumns;
    std::vector<Candidate> candidates;
    for (int r = row * image.rows / kGridRows; r < (row + 1) * image.rows / kGridRows; ++r) {
      for (int c = column * image.cols / kGridColumns; c < (column + 1) * image.cols / kGridColumns; ++c) {
        const float value = strength.at<float>(r, c);
        if (value >= kLeast && value >= largest.at<float>(r, c) && where.at<unsigned char>(r, c) != 0) {
          candidates.push_back({value, {c, r}});
        }
      }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.strength > b.strength; });
    for (std::size_t i = 0; i < std::min<std::size_t>(kInCell, candidates.size()); ++i) {
      corners.emplace_back(candidates[i].at);
    }
  }
  return corners;
}

struct Step {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

// The corners that come back to where they started when they are followed forward and back.
std::vector<Step> followed(const cv::Mat& before, const cv::Mat& after,
                           const std::vector<cv::Point2f>& corners) {
  constexpr double kFarthest = 0.5;  // pixels from where it started
  if (corners.empty()) {
    return {};
  }
  const cv::Size window(kWindow, kWindow);
  constexpr int kLevels = 3;
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01);
  std::vector<cv::Point2f> there;
  std::vector<cv::Point2f> back;
  std::vector<unsigned char> found;
  std::vector<unsigned char> returned;
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(before, after, corners, there, found, error, window, kLevels, until);
  cv::calcOpticalFlowPyrLK(after, before, there, back, returned, error, window, kLevels, until);
  const cv::Rect2f inside(0, 0, static_cast<float>(before.cols), static_cast<float>(before.rows));
  std::vector<Step> steps;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (found[i] != 0 && returned[i] != 0 && inside.contains(there[i]) &&
        cv::norm(back[i] - corners[i]) < kFarthest) {
      steps.push_back({{corners[i].x, corners[i].y}, {there[i].x, there[i].y}});
    }
  }
  return steps;
}

std::size_t cells_with(const std::vector<Step>& steps, cv::Size size) {
  std::set<std::pair<int, int>> cells;
  for (const Step& step : steps) {
    cells.emplace(static_cast<int>(step.from.y()) * kGridRows / size.height,
                  static_cast<int>(step.from.x()) * kGridColumns / size.width);
  }
  return cells.size();
}

// x' = scale_and_turn x + shift, as complex numbers.
struct Similarity {
  std::complex<double> scale_and_turn{1.0, 0.0};
  std::complex<double> shift{0.0, 0.0};
  Eigen::Vector2d operator()(const Eigen::Vector2d& p) const {
    const std::complex<double> q = scale_and_turn * std::complex<double>(p.x(), p.y()) + shift;
    return {q.real(), q.imag()};
  }
};

double error_of(const Similarity& motion, const Step& step) {
  return (motion(step.from) - step.to).norm();
}

// Sum of the squared errors; one that is larger than the tolerance counts as that.
double cost_of(const Similarity& motion, const std::vector<Step>& steps, double tolerance) {
  double sum = 0.0;
  for (const Step& step : steps) {
    const double error = std::min(error_of(motion, step), tolerance);
    sum += error * error;
  }
  return sum;
}

std::vector<const Step*> explained_by(const Similarity& motion, const std::vector<Step>& steps,
                                      double tolerance) {
  std::vector<const Step*> out;
  for (const Step& step : steps) {
    if (error_of(motion, step) < tolerance) {
      out.push_back(&step);
    }
  }
  return out;
}

// Least squares over these steps.
Similarity fitted(const std::vector<const Step*>& steps) {
  const auto complex = [](const Eigen::Vector2d& p) { return std::complex<double>(p.x(), p.y()); };
  std::complex<double> from{0.0, 0.0};
  std::complex<double> to{0.0, 0.0};
  for (const Step* step : steps) {
    from += complex(step->from);
    to += complex(step->to);
  }
  from /= static_cast<double>(steps.size());
  to /= static_cast<double>(steps.size());
  std::complex<double> product{0.0, 0.0};
  double square = 0.0;
  for (const Step* step : steps) {
    product += std::conj(complex(step->from) - from) * (complex(step->to) - to);
    square += std::norm(complex(step->from) - from);
  }
  Similarity out;
  out.scale_and_turn = square > 0.0 ? product / square : std::complex<double>(1.0, 0.0);
  out.shift = to - out.scale_and_turn * from;
  return out;
}

// The motion that explains the most corners, of those that some pairs of corners far enough apart define.
Similarity consensus(const std::vector<Step>& steps, double tolerance, double apart) {
  constexpr double kLargestChange = 0.25;  // of scale and turn between two images
  Similarity best;
  double least = cost_of(best, steps, tolerance);
  // The corners are in the order of their rows: partners this far apart in the list are apart in the image.
  for (const std::size_t part : {2, 3, 5, 7}) {
    const std::size_t offset = steps.size() / part;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Step& first = steps[i];
      const Step& second = steps[(i + offset) % steps.size()];
      if ((first.from - second.from).norm() < apart) {
        continue;
      }
      const Similarity tried = fitted({&first, &second});
      if (std::abs(tried.scale_and_turn - 1.0) > kLargestChange) {
        continue;
      }
      const double cost = cost_of(tried, steps, tolerance);
      if (cost < least) {
        least = cost;
        best = tried;
      }
    }
  }
  return best;
}

}  // namespace

std::optional<SharedMotion> shared_motion(const cv::Mat& before, const cv::Mat& after, const cv::Mat& scene) {
  const cv::Mat a = normalised(before);
  const cv::Mat b = normalised(after);
  const std::vector<Step> steps = followed(a, b, corners_of(a, usable(before, after, scene)));
  if (steps.size() < kFewestCorners || cells_with(steps, before.size()) < kFewestCells) {
    return std::nullopt;
  }
  const double tolerance = std::max(0.75, reference_width(before.cols, before.rows) / 200.0);
  constexpr double kMost = 0.6;
  const auto count = static_cast<double>(steps.size());
  SharedMotion out;
  // The motion that explains the most corners, refined by least squares.
  Similarity motion = consensus(steps, tolerance, reference_width(before.cols, before.rows) / 8.0);
  std::vector<const Step*> explained;
  for (int round = 0; round < 3; ++round) {
    explained = explained_by(motion, steps, tolerance);
    if (explained.size() < 2) {
      return out;
    }
    motion = fitted(explained);
  }
  out.share = static_cast<double>(explained.size()) / count;
  // Its size, and what of it the errors of the corners alone could be.
  double moved = 0.0;
  double error = 0.0;
  for (const Step* step : explained) {
    moved += (motion(step->from) - step->from).squaredNorm();
    error += (motion(step->from) - step->to).squaredNorm();
  }
  const auto n = static_cast<double>(explained.size());
  constexpr double kParameters = 4.0;
  const double by_chance = kParameters * error / std::max(1.0, 2.0 * n - kParameters) / n;  // variance
  constexpr double kSignificant = 9.0;
  constexpr double kBetter = 0.5;
  const bool moves = out.share >= kMost && moved / n > kSignificant * by_chance &&
                     cost_of(motion, steps, tolerance) < kBetter * cost_of(Similarity{}, steps, tolerance);
  out.pixels = moves ? std::sqrt(moved / n) : 0.0;
  return out;
}

}  // namespace telemime
